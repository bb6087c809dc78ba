#include "ground/renderer/isotherms.h"

#include <gtest/gtest.h>

#include <cmath>

namespace isotherm {
namespace {

TEST(IsothermsTest, AreReadWithUnitsAndColours) {
  const auto lines = ParseIsotherms("60, 80#00Ff10 ,212F");
  ASSERT_TRUE(lines);
  ASSERT_EQ(lines->size(), 3U);
  EXPECT_EQ((*lines)[0].celsius, 60.0);
  EXPECT_EQ((*lines)[0].colour, (Rgb8{255, 255, 255}));
  EXPECT_EQ((*lines)[1].colour, (Rgb8{0, 255, 16}));
  EXPECT_NEAR((*lines)[2].celsius, 100.0, 1e-9);
  EXPECT_TRUE(ParseIsotherms("")->empty());
  EXPECT_TRUE(ParseIsotherms("  ")->empty());
}

TEST(IsothermsTest, WhatCannotBeReadIsNamed) {
  for (const char* wrong : {"60,", "60,,80", "sixty", "60#12345", "60#12345g", "60#", "#ffffff"}) {
    const auto lines = ParseIsotherms(wrong);
    ASSERT_FALSE(lines) << wrong;
    EXPECT_EQ(lines.error().code(), StatusCode::kInvalidArgument) << wrong;
    EXPECT_NE(lines.error().message().find('\''), std::string::npos) << lines.error().message();
  }
  std::string many = "1";
  for (int i = 0; i < 32; ++i) many += ",1";
  EXPECT_FALSE(ParseIsotherms(many));
}

TEST(BandsTest, HaveTwoEndsOfWhichOneMayBeMissing) {
  const auto bands = ParseBands("80..100#ff00ff, 200.., ..-5");
  ASSERT_TRUE(bands);
  ASSERT_EQ(bands->size(), 3U);
  EXPECT_TRUE((*bands)[0].Contains(80.0) && (*bands)[0].Contains(100.0));
  EXPECT_FALSE((*bands)[0].Contains(79.99) || (*bands)[0].Contains(100.01));
  EXPECT_EQ((*bands)[0].colour, (Rgb8{255, 0, 255}));
  EXPECT_TRUE((*bands)[1].Contains(1500.0));
  EXPECT_FALSE((*bands)[1].Contains(199.0));
  EXPECT_FALSE((*bands)[1].colour);
  EXPECT_TRUE((*bands)[2].Contains(-90.0));
  EXPECT_FALSE((*bands)[2].Contains(0.0));
}

TEST(BandsTest, ImpossibleOnesAreRefused) {
  for (const char* wrong : {"80", "..", "100..80", "80..80", "a..b", "1..2,3", "1..2#red"}) {
    EXPECT_FALSE(ParseBands(wrong)) << wrong;
  }
}

}  // namespace
}  // namespace isotherm
