#include "common/base/enum_array.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

namespace isotherm {
namespace {

enum class Colour { kRed, kGreen, kBlue, kCount };

TEST(EnumArrayTest, AllValuesAreListedInOrderWithoutTheirCount) {
  EXPECT_THAT(AllValues<Colour>(),
              ::testing::ElementsAre(Colour::kRed, Colour::kGreen, Colour::kBlue));
}

TEST(EnumArrayTest, EachValueHasAnElementOfItsOwn) {
  EnumArray<Colour, int> counts;
  counts[Colour::kGreen] = 5;
  ++counts[Colour::kBlue];
  EXPECT_EQ(counts[Colour::kRed], 0);
  EXPECT_EQ(counts[Colour::kGreen], 5);
  EXPECT_EQ(counts[Colour::kBlue], 1);
}

TEST(EnumArrayTest, AListMayHaveAnyOrderAndNeedNotBeWhole) {
  const EnumArray<Colour, std::string> names = {{Colour::kBlue, "blue"}, {Colour::kRed, "red"}};
  EXPECT_EQ(names[Colour::kRed], "red");
  EXPECT_EQ(names[Colour::kGreen], "");
  EXPECT_EQ(names[Colour::kBlue], "blue");
}

TEST(EnumArrayTest, ArraysAreEqualIfAllElementsAre) {
  const EnumArray<Colour, int> some = {{Colour::kRed, 1}, {Colour::kBlue, 2}};
  EnumArray<Colour, int> others;
  others[Colour::kRed] = 1;
  EXPECT_FALSE(some == others);
  others[Colour::kBlue] = 2;
  EXPECT_TRUE(some == others);
}

}  // namespace
}  // namespace isotherm
