#include "tests/lint/text_rules.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <iostream>

namespace isotherm::lint {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

/// Longer than this deserves a hard look.
constexpr std::size_t kLongFileLines = 400;

std::vector<std::string> MessagesFor(const std::string& path,
                                     const std::vector<std::string>& lines) {
  std::vector<std::string> messages;
  for (Violation& violation : CheckText({{path, lines}}, ISOTHERM_SOURCE_DIR)) {
    messages.push_back(std::move(violation.message));
  }
  return messages;
}

TEST(TextRulesTest, TheRepositoryKeepsTheRules) {
  const std::vector<SourceFile> files = ReadSourceTree(ISOTHERM_SOURCE_DIR);
  ASSERT_GT(files.size(), 50U) << "nothing to check in " ISOTHERM_SOURCE_DIR;
  const std::vector<Violation> violations = CheckText(files, ISOTHERM_SOURCE_DIR);
  EXPECT_TRUE(violations.empty()) << ToString(violations);
  std::cout << "files over " << kLongFileLines << " lines:\n"
            << ToString(FindLongFiles(files, kLongFileLines));
}

TEST(TextRulesTest, PlacesOnOneMachineAreFound) {
  const std::string home = std::string("/ho") + "me/";
  EXPECT_THAT(MessagesFor("docs/a.md", {"see " + home + "somebody/data"}),
              ElementsAre(HasSubstr("names a place on one machine")));
  EXPECT_THAT(MessagesFor("docs/a.md", {"the folder project" + home + "x is fine"}), IsEmpty());
}

TEST(TextRulesTest, HeadersAreGuardedAndKeepNamespacesToThemselves) {
  EXPECT_THAT(MessagesFor("common/a.h", {"int F();"}), ElementsAre(HasSubstr("#pragma once")));
  EXPECT_THAT(MessagesFor("common/a.h", {"#pragma once", "using namespace std;"}),
              ElementsAre(HasSubstr("using namespace")));
}

TEST(TextRulesTest, DisabledTestsAndDetachedThreadsAreFound) {
  EXPECT_THAT(MessagesFor("common/a_test.cc", {std::string("TEST(A, DISABLED") + "_B) {}"}),
              ElementsAre(HasSubstr("disabled test")));
  EXPECT_THAT(MessagesFor("common/a.cc", {std::string("  thread.det") + "ach();"}),
              ElementsAre(HasSubstr("detached")));
}

TEST(TextRulesTest, CMakeFilesListTheirSourcesAndSayWhatTheyAreFor) {
  EXPECT_THAT(MessagesFor("a/CMakeLists.txt", {"# Something.", "file(GLOB sources *.cc)"}),
              ElementsAre(HasSubstr("globbing")));
  EXPECT_THAT(MessagesFor("a/CMakeLists.txt", {"add_subdirectory(b)"}),
              ElementsAre(HasSubstr("what the folder is for")));
  EXPECT_THAT(
      MessagesFor("a/CMakeLists.txt", {"# x", "target_compile_options(a PRIVATE -march=native)"}),
      ElementsAre(HasSubstr("CPU flags")));
}

TEST(TextRulesTest, LinksLeadSomewhere) {
  EXPECT_THAT(MessagesFor("a.md", {"[x](no/such/file.md)"}),
              ElementsAre(HasSubstr("link leads nowhere")));
  EXPECT_THAT(MessagesFor("a.md", {"[x](CMakeLists.txt) [y](https://example.org/) [z](#here)"}),
              IsEmpty());
}

TEST(TextRulesTest, FilesThatAPageNamesAreThere) {
  const auto found = [](const char* line) { return MessagesFor("docs/a.md", {line}); };
  EXPECT_THAT(found("see `tests/lint/no_such_file.cc`."),
              ElementsAre("names a file that is not there: tests/lint/no_such_file.cc"));
  EXPECT_THAT(found("in tests/no_such_folder/, or deploy/no.sh"), ::testing::SizeIs(2));
  EXPECT_THAT(found("`tests/lint`, tests/lint/text_rules.cc. `tests/lint/source_tree`"), IsEmpty());
  EXPECT_THAT(found("/etc/edge/x, build/edge/x, $ISOTHERM/docs/x, [y](docs/../README.md)"),
              ElementsAre(HasSubstr("link leads nowhere")))
      << "places elsewhere; what a link leads to is relative";
  EXPECT_THAT(MessagesFor("CHANGELOG.md", {"edge/what_was.cc is gone"}), IsEmpty());
}

TEST(TextRulesTest, TestsThatAPageNamesAreThere) {
  const std::vector<SourceFile> files = {{"a_test.cc", {"TEST_F(HereTest, IsGreen) {}"}},
                                         {"docs/a.md", {"| `HereTest`, `GoneTest` |"}}};
  const std::vector<Violation> violations = CheckText(files, ISOTHERM_SOURCE_DIR);
  ASSERT_EQ(violations.size(), 1U);
  EXPECT_EQ(violations.front().message, "names a test that is not there: GoneTest");
}

TEST(TextRulesTest, LongFilesAreNoticed) {
  const std::vector<SourceFile> files = {
      {"a.cc", std::vector<std::string>(kLongFileLines + 1, "x")},
      {"b.cc", std::vector<std::string>(kLongFileLines, "x")}};
  EXPECT_EQ(FindLongFiles(files, kLongFileLines).size(), 1U);
}

/// The walk itself: a tree on disk with one broken file and with folders that are not ours to
/// check.
TEST(TextRulesTest, TheWalkFindsOurFilesAndSkipsBuildTrees) {
  const std::filesystem::path root =
      std::filesystem::path(::testing::TempDir()) / "isotherm_lint_walk";
  std::filesystem::remove_all(root);
  for (const char* path : {"common/base/a.cc", "build/dev/b.cc", "node_modules/c.h", "image.png"}) {
    std::filesystem::create_directories((root / path).parent_path());
    std::ofstream(root / path) << "\tint x;\n";
  }
  const std::vector<SourceFile> files = ReadSourceTree(root);
  ASSERT_EQ(files.size(), 1U);
  EXPECT_EQ(files.front().path, "common/base/a.cc");
  EXPECT_THAT(CheckText(files, root), Contains(::testing::Field(&Violation::message, "tab")));
  std::filesystem::remove_all(root);
}

}  // namespace
}  // namespace isotherm::lint
