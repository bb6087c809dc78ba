#include "ground/renderer/isotherms.h"

#include <gtest/gtest.h>

#include <cmath>

#include "ground/options/ground_options.pb.h"

namespace isotherm {
namespace {

Result<std::vector<IsothermLine>> Isotherms(std::string_view text) {
  RendererOptions options;
  if (Status status = ParseIsotherms(text, options); !status.ok()) return Err(status);
  return IsothermsOf(options);
}

Result<std::vector<TemperatureBand>> Bands(std::string_view text) {
  RendererOptions options;
  if (Status status = ParseBands(text, options); !status.ok()) return Err(status);
  return BandsOf(options);
}

TEST(IsothermsTest, AreReadWithUnitsAndColours) {
  const auto lines = Isotherms("60, 80#00Ff10 ,212F");
  ASSERT_TRUE(lines);
  ASSERT_EQ(lines->size(), 3U);
  EXPECT_EQ((*lines)[0].celsius, 60.0);
  EXPECT_EQ((*lines)[0].colour, (Rgb8{255, 255, 255}));
  EXPECT_EQ((*lines)[1].colour, (Rgb8{0, 255, 16}));
  EXPECT_NEAR((*lines)[2].celsius, 100.0, 1e-9);
  EXPECT_TRUE(Isotherms("")->empty());
  EXPECT_TRUE(Isotherms("  ")->empty());
}

TEST(IsothermsTest, WhatCannotBeReadIsNamed) {
  for (const char* wrong : {"60,", "60,,80", "sixty", "60#12345", "60#12345g", "60#", "#ffffff"}) {
    const auto lines = Isotherms(wrong);
    ASSERT_FALSE(lines) << wrong;
    EXPECT_EQ(lines.error().code(), StatusCode::kInvalidArgument) << wrong;
    EXPECT_NE(lines.error().message().find('\''), std::string::npos) << lines.error().message();
  }
  std::string many = "1";
  for (int i = 0; i < 32; ++i) many += ",1";
  EXPECT_FALSE(Isotherms(many));
}

TEST(BandsTest, HaveTwoEndsOfWhichOneMayBeMissing) {
  const auto bands = Bands("80..100#ff00ff, 200.., ..-5");
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
    EXPECT_FALSE(Bands(wrong)) << wrong;
  }
}

TEST(IsothermsTest, ThoseOfTheCommandLineReplaceThoseOfTheFile) {
  RendererOptions options;
  options.add_isotherm()->set_celsius(5.0);
  options.add_band()->set_min_celsius(5.0);
  ASSERT_TRUE(ParseIsotherms("60", options).ok());
  ASSERT_TRUE(ParseBands("70..", options).ok());
  ASSERT_EQ(options.isotherm_size(), 1);
  EXPECT_EQ(options.isotherm(0).celsius(), 60.0);
  ASSERT_EQ(options.band_size(), 1);
  EXPECT_EQ(options.band(0).min_celsius(), 70.0);
}

TEST(IsothermsTest, AFileMayHaveWrongOnesToo) {
  RendererOptions options;
  options.add_isotherm();
  EXPECT_FALSE(IsothermsOf(options)) << "no temperature";
  options.mutable_isotherm(0)->set_celsius(60.0);
  EXPECT_TRUE(IsothermsOf(options));
  for (const char* wrong : {"", "#12345", "#12345g", "1234567", "#+12345", "green"}) {
    options.mutable_isotherm(0)->set_colour(wrong);
    EXPECT_FALSE(IsothermsOf(options)) << wrong;
  }
  TemperatureBandOptions& band = *options.add_band();
  EXPECT_FALSE(BandsOf(options)) << "no end";
  band.set_min_celsius(80.0);
  band.set_max_celsius(60.0);
  EXPECT_FALSE(BandsOf(options)) << "upside down";
  band.set_max_celsius(std::nan(""));
  EXPECT_FALSE(BandsOf(options)) << "not a number";
}

}  // namespace
}  // namespace isotherm
