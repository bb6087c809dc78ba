#include "tests/lint/word_rules.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace isotherm::lint {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

std::vector<std::string> MessagesFor(const std::vector<std::string>& lines) {
  std::vector<std::string> messages;
  for (Violation& violation : CheckWords({{"common/a.h", lines}})) {
    messages.push_back(std::move(violation.message));
  }
  return messages;
}

TEST(WordRulesTest, TheRepositoryKeepsTheRules) {
  const std::vector<SourceFile> files = ReadSourceTree(ISOTHERM_SOURCE_DIR);
  ASSERT_GT(files.size(), 50U) << "nothing to check in " ISOTHERM_SOURCE_DIR;
  const std::vector<Violation> violations = CheckWords(files);
  EXPECT_TRUE(violations.empty()) << ToString(violations);
}

TEST(WordRulesTest, DocCommentsThatAreFragmentsAreFound) {
  for (const char* word : {"Of", "What", "Those", "That", "Whether", "Which"}) {
    const std::string rest = std::string(word) + " the points.";
    EXPECT_THAT(MessagesFor({"/// " + rest}), ElementsAre(HasSubstr("fragment: ")));
    EXPECT_THAT(MessagesFor({"  int x = 0;  ///< " + rest}), ElementsAre(HasSubstr("fragment: ")));
    EXPECT_THAT(MessagesFor({"// " + rest}), IsEmpty()) << "remarks within code may be short";
  }
  EXPECT_THAT(MessagesFor({"/// Offers the points.", "/// Whatever comes."}), IsEmpty());
}

TEST(WordRulesTest, OnlyTheBeginningOfACommentCounts) {
  EXPECT_THAT(
      MessagesFor({"/// Returns the points of a voxel,", "/// What follows may be anything."}),
      IsEmpty());
  EXPECT_THAT(MessagesFor({"int x = 0;  ///< The points that a block has,",
                           "            ///< Of which there are few."}),
              IsEmpty());
  EXPECT_THAT(MessagesFor({"/// Returns one.", "int F();", "/// Of the block."}),
              ElementsAre(HasSubstr("fragment: Of")));
}

TEST(WordRulesTest, CommentsThatRunOnOverTwoFieldsAreFound) {
  EXPECT_THAT(MessagesFor({"int a = 0;  ///< At least this, ...", "int b = 0;  ///< ... or this."}),
              ElementsAre(HasSubstr("runs on")));
  EXPECT_THAT(MessagesFor({"/// Settings 1, 2, ... of the camera."}), IsEmpty());
}

TEST(WordRulesTest, BoundsAreCalledMaxAndMin) {
  const auto defined = [](const std::string& name) {
    return MessagesFor({"constexpr double " + name + " = 1.0;"});
  };
  EXPECT_THAT(defined(std::string("kLo") + "ngest_s"), ElementsAre(HasSubstr("kMax or kMin")));
  EXPECT_THAT(defined(std::string("kFe") + "westPoints"), ElementsAre(HasSubstr("kMax or kMin")));
  EXPECT_THAT(defined("kMaxPoints"), IsEmpty());
  EXPECT_THAT(defined("kMostlyFlat"), IsEmpty()) << "another word that begins alike";
}

TEST(WordRulesTest, WordsThatWereReplacedAreFoundInCommentsOnly) {
  const std::string old = std::string("pic") + "ture";
  EXPECT_THAT(MessagesFor({"// A " + old + " of the door."}),
              ElementsAre(HasSubstr("say 'image'")));
  EXPECT_THAT(MessagesFor({"const auto x = from." + old + ";"}), IsEmpty());
  EXPECT_THAT(MessagesFor({"const char* url = \"https://" + old + "\";"}), IsEmpty());
  EXPECT_THAT(MessagesFor({"// The " + old + "squeness of a door."}), IsEmpty());
}

}  // namespace
}  // namespace isotherm::lint
