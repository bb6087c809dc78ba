#include "tests/lint/threaded_tests.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

namespace isotherm::lint {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

std::vector<std::string> MessagesFor(const std::vector<SourceFile>& files) {
  std::vector<std::string> messages;
  for (Violation& violation : CheckThreadedTests(files))
    messages.push_back(std::move(violation.message));
  return messages;
}

const SourceFile kList = {"cmake/Isotherm.cmake",
                          {"set(isotherm_threaded_tests queue_test", "  other_test)  # Watched."}};
const SourceFile kDeclaration = {
    "a/CMakeLists.txt",
    {"isotherm_test(NAME queue_test SRCS queue_test.cc)",
     "isotherm_test(NAME other_test SRCS b.cc)", "isotherm_test(NAME new_test SRCS",
     "  old_test.cc new_test.cc  # Two.", "  DEPS x)"}};

TEST(ThreadedTestsTest, TheRepositoryKeepsTheRule) {
  const std::vector<Violation> violations = CheckThreadedTests(ReadSourceTree(ISOTHERM_SOURCE_DIR));
  EXPECT_TRUE(violations.empty()) << ToString(violations);
}

TEST(ThreadedTestsTest, AThreadInATestThatIsNotListedIsFound) {
  EXPECT_THAT(MessagesFor({kList, kDeclaration, {"a/new_test.cc", {"std::jthread thread;"}}}),
              ElementsAre(AllOf(HasSubstr("new_test"), HasSubstr("std::jthread"))));
  EXPECT_THAT(MessagesFor({kList, kDeclaration, {"a/queue_test.cc", {"std::jthread thread;"}}}),
              IsEmpty());
}

TEST(ThreadedTestsTest, SoIsOneInTheClassThatIsTested) {
  EXPECT_THAT(MessagesFor({kList, kDeclaration, {"a/new.h", {"  BoundedQueue<int> queue_;"}}}),
              ElementsAre(HasSubstr("new_test")));
}

TEST(ThreadedTestsTest, AReasonIsEnough) {
  EXPECT_THAT(MessagesFor({kList,
                           kDeclaration,
                           {"a/old_test.cc", {"// not watched by the thread sanitizer: it forks."}},
                           {"a/new_test.cc", {"std::async(F);"}}}),
              IsEmpty());
}

TEST(ThreadedTestsTest, ANameThatIsNoTestIsFound) {
  EXPECT_THAT(
      MessagesFor({kList, {"a/CMakeLists.txt", {"isotherm_test(NAME queue_test SRCS a.cc)"}}}),
      ElementsAre(HasSubstr("names no test: other_test")));
}

TEST(ThreadedTestsTest, TestsOfProgramsAreNotAsked) {
  EXPECT_THAT(MessagesFor({{"a/CMakeLists.txt",
                            {"isotherm_test(NAME new_test SRCS new_test.cc LABELS system)"}},
                           {"a/new_test.cc", {"std::jthread thread;"}}}),
              IsEmpty());
}

}  // namespace
}  // namespace isotherm::lint
