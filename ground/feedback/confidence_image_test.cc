#include "ground/feedback/confidence_image.h"

#include <gtest/gtest.h>

#include <cmath>
#include <iostream>
#include <random>

#include "common/messages/messages.h"

namespace isotherm {
namespace {

constexpr auto kGood = static_cast<std::uint8_t>(ConditionClass::kGood);
constexpr auto kAcceptable = static_cast<std::uint8_t>(ConditionClass::kAcceptable);
constexpr auto kBad = static_cast<std::uint8_t>(ConditionClass::kBad);

ViewMaps View(int width, int height, float cosine) {
  ViewMaps view;
  view.Resize(width, height);
  view.celsius.Fill(20.0F);
  view.distance_class.Fill(kGood);
  view.angle_class.Fill(kGood);
  view.motion_class.Fill(kNeverMeasured);  // Unchecked.
  view.cos_view.Fill(cosine);
  view.distance_m.Fill(0.5F);
  return view;
}

/// Width and height as the PNG's header says (big-endian, at bytes 16 and 20).
std::pair<int, int> SizeOf(const std::vector<std::uint8_t>& png) {
  const auto number = [&](std::size_t at) {
    return png[at] << 24 | png[at + 1] << 16 | png[at + 2] << 8 | png[at + 3];
  };
  return {number(16), number(20)};
}

TEST(ConfidenceImageTest, ColoursSayTheWorstClass) {
  ViewMaps view = View(5, 4, 1.0F);
  view.angle_class.At(1, 0) = kAcceptable;
  view.distance_class.At(2, 0) = kBad;
  view.distance_class.At(3, 0) = view.angle_class.At(3, 0) = kNeverMeasured;
  view.cos_view.At(4, 0) = NAN;
  const RgbImage image = DrawConfidence(view, false);
  const Rgb8 good = image.At(0, 0);
  EXPECT_GT(good.g, std::max(good.r, good.b));
  const Rgb8 acceptable = image.At(1, 0);
  EXPECT_GT(std::min(acceptable.r, acceptable.g), acceptable.b);
  const Rgb8 bad = image.At(2, 0);
  EXPECT_GT(bad.r, std::max(bad.g, bad.b));
  const Rgb8 never = image.At(3, 0);
  EXPECT_GT(never.b, std::max(never.r, never.g));
  const Rgb8 nothing = image.At(4, 0);
  EXPECT_LT(std::max({nothing.r, nothing.g, nothing.b}), 40);
}

TEST(ConfidenceImageTest, WhatTurnsAwayIsDarker) {
  EXPECT_GT(DrawConfidence(View(4, 4, 1.0F), false).At(0, 0).g,
            DrawConfidence(View(4, 4, 0.3F), false).At(0, 0).g);
}

TEST(ConfidenceImageTest, ALostTrackIsFramed) {
  const ViewMaps view = View(40, 30, 1.0F);
  EXPECT_EQ(DrawConfidence(view, true).At(0, 15), (Rgb8{255, 0, 0}));
  EXPECT_EQ(DrawConfidence(view, true).At(39, 15), (Rgb8{255, 0, 0}));
  EXPECT_EQ(DrawConfidence(view, true).At(20, 15), DrawConfidence(view, false).At(20, 15));
}

TEST(ConfidenceImageTest, AnImageThatPacksBadlyIsHalvedUntilItFits) {
  constexpr std::uint32_t kSeed = 9;
  std::cout << "seed " << kSeed << "\n";
  std::minstd_rand random(kSeed);
  RgbImage noise(640, 480);  // No code packs that.
  for (Rgb8& pixel : noise.pixels()) {
    const auto value = static_cast<std::uint32_t>(random());
    pixel = {static_cast<std::uint8_t>(value >> 8), static_cast<std::uint8_t>(value >> 13),
             static_cast<std::uint8_t>(value >> 18)};
  }
  const std::vector<std::uint8_t> bytes = EncodeWithin(noise, kMaxConfidenceImageBytes);
  ASSERT_FALSE(bytes.empty());
  EXPECT_LE(bytes.size(), kMaxConfidenceImageBytes);
  EXPECT_EQ(SizeOf(bytes), std::make_pair(80, 60)) << "160 x 120 x 3 bytes are too many";
}

TEST(ConfidenceImageTest, AnOrdinaryImageKeepsItsSize) {
  ViewMaps view = View(160, 120, 0.9F);
  for (int y = 0; y < 120; ++y) {
    for (int x = 0; x < 160; ++x) {
      if ((x / 16 + y / 16) % 3 == 0) view.angle_class.At(x, y) = kBad;
    }
  }
  const std::vector<std::uint8_t> bytes =
      EncodeWithin(DrawConfidence(view, false), kMaxConfidenceImageBytes);
  EXPECT_EQ(SizeOf(bytes), std::make_pair(160, 120));
}

TEST(ConfidenceImageTest, NothingFitsIntoNothing) {
  EXPECT_TRUE(EncodeWithin(RgbImage(64, 64), 10).empty());
  EXPECT_TRUE(EncodeWithin(RgbImage(), kMaxConfidenceImageBytes).empty());
}

}  // namespace
}  // namespace isotherm
