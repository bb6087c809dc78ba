#include "common/simulation/thermal_errors.h"

#include <gtest/gtest.h>

#include <cmath>

#include "common/simulation/simulation_options.pb.h"

namespace isotherm {
namespace {

constexpr std::uint16_t kCold = 29'715;  // 24 °C
constexpr std::uint16_t kHot = 39'315;   // 120 °C
constexpr double kContrast_k = 96.0;

SceneInfluenceOptions Influence(double near_fraction, double near_sigma_px, double total_fraction) {
  SceneInfluenceOptions influence;
  influence.set_near_fraction(near_fraction);
  influence.set_near_sigma_px(near_sigma_px);
  influence.set_total_fraction(total_fraction);
  return influence;
}

/// Cold on the left, hot on the right.
Image<std::uint16_t> Halves(int width, int height) {
  Image<std::uint16_t> counts(width, height, kCold);
  for (int y = 0; y < height; ++y) {
    for (int x = width / 2; x < width; ++x) counts.At(x, y) = kHot;
  }
  return counts;
}

TEST(ThermalErrorsTest, TheTotalDrawsAllPixelsTowardsTheMeanOfTheImage) {
  Image<std::uint16_t> counts = Halves(64, 40);
  AddSceneInfluence(Influence(0.0, 10.0, 0.04), counts);
  const double expected_k = 0.04 * kContrast_k / 2.0;
  EXPECT_NEAR((counts.At(0, 0) - kCold) / 100.0, expected_k, 0.01);
  EXPECT_NEAR((kHot - counts.At(63, 39)) / 100.0, expected_k, 0.01);
}

/// Across an infinite straight edge the mean of the surroundings is the normal distribution's
/// integral.
TEST(ThermalErrorsTest, TheNearOnesAreWeighedByAGaussian) {
  constexpr double kSigma_px = 12.0, kFraction = 0.05;
  Image<std::uint16_t> counts = Halves(240, 120);
  AddSceneInfluence(Influence(kFraction, kSigma_px, 0.0), counts);
  for (const int x : {60, 100, 110, 119}) {
    const double from_edge_px = 120 - 0.5 - x;
    const double hot = 0.5 * std::erfc(from_edge_px / (kSigma_px * std::sqrt(2.0)));
    EXPECT_NEAR((counts.At(x, 60) - kCold) / 100.0, kFraction * hot * kContrast_k, 0.03) << x;
  }
}

TEST(ThermalErrorsTest, WhatHasNoValueHasNoInfluenceAndGetsNone) {
  Image<std::uint16_t> counts(32, 32, kCold);
  for (int y = 0; y < 32; ++y) counts.At(31, y) = 0;
  const Image<std::uint16_t> before = counts;
  AddSceneInfluence(Influence(0.05, 8.0, 0.05), counts);
  EXPECT_EQ(counts, before);
}

TEST(ThermalErrorsTest, ThePatternIsTheSameForTheSameStreamAndAsWideAsSaid) {
  constexpr double kSigma_k = 0.3;
  Image<std::uint16_t> first(200, 100, kCold), again = first, other = first;
  AddPattern(kSigma_k, 5, kCentikelvin, first);
  AddPattern(kSigma_k, 5, kCentikelvin, again);
  AddPattern(kSigma_k, 6, kCentikelvin, other);
  EXPECT_EQ(first, again);
  EXPECT_NE(first, other);
  double squares = 0.0;
  for (const std::uint16_t count : first.pixels()) squares += std::pow((count - kCold) / 100.0, 2);
  EXPECT_NEAR(std::sqrt(squares / static_cast<double>(first.size())), kSigma_k, 0.02 * kSigma_k);
}

TEST(ThermalErrorsTest, FlickerHasItsSpreadAndIsForgotten) {
  constexpr double kSigma_k = 0.2, kMemory_s = 0.5;
  constexpr int kTimes = 20'000;
  const auto at = [](double time_s) { return FlickerKelvin(kSigma_k, kMemory_s, time_s, 7); };
  double squares = 0.0, soon = 0.0, late = 0.0;
  for (int i = 0; i < kTimes; ++i) {
    const double time_s = 0.37 * i;
    squares += at(time_s) * at(time_s);
    soon += at(time_s) * at(time_s + 0.05);
    late += at(time_s) * at(time_s + 4.0 * kMemory_s);
  }
  EXPECT_NEAR(std::sqrt(squares / kTimes), kSigma_k, 0.02 * kSigma_k);
  EXPECT_GT(soon / squares, 0.9);
  EXPECT_NEAR(late / squares, 0.0, 0.03);
  EXPECT_EQ(FlickerKelvin(0.0, kMemory_s, 1.0, 7), 0.0);
}

TEST(ThermalErrorsTest, WhatTheScaleCannotHoldBecomesNoValue) {
  Image<std::uint16_t> counts(2, 1, 65'000);
  counts.At(1, 0) = 0;
  AddKelvin(10.0, kCentikelvin, counts);
  EXPECT_EQ(counts.At(0, 0), 0);
  EXPECT_EQ(counts.At(1, 0), 0);
}

}  // namespace
}  // namespace isotherm
