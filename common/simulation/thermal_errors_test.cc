#include "common/simulation/thermal_errors.h"

#include <gtest/gtest.h>

#include <cmath>

namespace isotherm {
namespace {

constexpr std::uint16_t kCold = 29'715;  // 24 °C
constexpr float kCold_celsius = 24.0F, kHot_celsius = 120.0F;
constexpr double kContrast_k = 96.0;

/// Cold on the left, hot on the right.
Image<float> Halves(int width, int height) {
  Image<float> celsius(width, height, kCold_celsius);
  for (int y = 0; y < height; ++y) {
    for (int x = width / 2; x < width; ++x) celsius.At(x, y) = kHot_celsius;
  }
  return celsius;
}

TEST(ThermalErrorsTest, TheTotalDrawsAllPixelsTowardsTheMeanOfTheImage) {
  Image<float> celsius = Halves(64, 40);
  AddSceneInfluence({.near_fraction = 0.0, .near_sigma_px = 10.0, .total_fraction = 0.04}, celsius);
  const double expected_k = 0.04 * kContrast_k / 2.0;
  EXPECT_NEAR(celsius.At(0, 0) - kCold_celsius, expected_k, 1e-3);
  EXPECT_NEAR(kHot_celsius - celsius.At(63, 39), expected_k, 1e-3);
}

/// Across an infinite straight edge the mean of the surroundings is the normal distribution's
/// integral.
TEST(ThermalErrorsTest, TheNearOnesAreWeighedByAGaussian) {
  constexpr double kSigma_px = 12.0, kFraction = 0.05;
  Image<float> celsius = Halves(240, 120);
  AddSceneInfluence({.near_fraction = kFraction, .near_sigma_px = kSigma_px}, celsius);
  for (const int x : {60, 100, 110, 119}) {
    const double from_edge_px = 120 - 0.5 - x;
    const double hot = 0.5 * std::erfc(from_edge_px / (kSigma_px * std::sqrt(2.0)));
    EXPECT_NEAR(celsius.At(x, 60) - kCold_celsius, kFraction * hot * kContrast_k, 0.03) << x;
  }
}

TEST(ThermalErrorsTest, WhatHasNoValueHasNoInfluenceAndGetsNone) {
  Image<float> celsius(32, 32, kCold_celsius);
  for (int y = 0; y < 32; ++y) celsius.At(31, y) = NAN;
  AddSceneInfluence({.near_fraction = 0.05, .near_sigma_px = 8.0, .total_fraction = 0.05}, celsius);
  for (int y = 0; y < 32; ++y) {
    for (int x = 0; x < 31; ++x) ASSERT_NEAR(celsius.At(x, y), kCold_celsius, 1e-3);
    ASSERT_TRUE(std::isnan(celsius.At(31, y)));
  }
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
    late += at(time_s) * at(time_s + 2.0 * kMemory_s);
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
