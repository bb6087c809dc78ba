#include "common/base/terminal_line.h"

#include <gtest/gtest.h>

#include <vector>

namespace isotherm {
namespace {

const std::vector<std::string> kParts = {"closer", "tracked", "view 55 % good"};

TEST(FitLineTest, PartsThatDoNotFitAreLeftOutAsAWhole) {
  EXPECT_EQ(FitLine(kParts, " | ", 100), "closer | tracked | view 55 % good");
  EXPECT_EQ(FitLine(kParts, " | ", 33), "closer | tracked | view 55 % good");
  EXPECT_EQ(FitLine(kParts, " | ", 32), "closer | tracked");
  EXPECT_EQ(FitLine(kParts, " | ", 16), "closer | tracked");
  EXPECT_EQ(FitLine(kParts, " | ", 15), "closer");
  EXPECT_EQ(FitLine(std::vector<std::string>{"a", "too long", "b"}, " ", 4), "a b");
}

TEST(FitLineTest, OnlyAFirstPartThatIsTooLongIsCut) {
  EXPECT_EQ(FitLine(kParts, " | ", 3), "clo");
  EXPECT_EQ(FitLine({}, " | ", 3), "");
}

TEST(FitLineTest, ColumnsAreCharactersNotBytes) {
  const std::vector<std::string> parts = {"20 °C", "±1"};
  EXPECT_EQ(FitLine(parts, " ", 8), "20 °C ±1");
  EXPECT_EQ(FitLine(parts, " ", 4), "20 °");
}

}  // namespace
}  // namespace isotherm
