#include "ground/thermal/uncertainty_budget.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "ground/thermal/sigma_code.h"
#include "ground/thermal/voxel_layout.h"

namespace isotherm {
namespace {

constexpr double kExact = 1e-12;
constexpr double kSingle = 1e-9;  ///< 0.025 K is a float.
/// Half a step of 0.025 K over the root of 3.
constexpr double kResolution_k = 0.0125 / 1.7320508075688772;

TEST(SigmaCodeTest, IsWithinThreePercentAndInTheOrderOfTheValues) {
  constexpr float kHalfStep = 0.5F / 16.0F;
  std::uint8_t last = 0;
  float sigma_k = SigmaCode::kMin_k;
  while (sigma_k < SigmaCode::kMax_k) {
    const std::uint8_t code = SigmaCode::Of(sigma_k);
    ASSERT_GE(code, std::max<std::uint8_t>(last, 1));
    ASSERT_NEAR(SigmaCode::Kelvin(code), sigma_k, kHalfStep * sigma_k);
    last = code;
    sigma_k *= 1.01F;
  }
  for (int code = 1; code <= 255; ++code) {
    const auto byte = static_cast<std::uint8_t>(code);
    ASSERT_EQ(SigmaCode::Of(SigmaCode::Kelvin(byte)), byte);
  }
}

TEST(SigmaCodeTest, BeyondItsEndsIsTheEndAndZeroIsNotKnown) {
  EXPECT_EQ(SigmaCode::Of(0.0F), 1);
  EXPECT_EQ(SigmaCode::Of(1e9F), 255);
  EXPECT_EQ(SigmaCode::Of(INFINITY), 255);
  EXPECT_EQ(SigmaCode::Kelvin(1), SigmaCode::kMin_k);
  EXPECT_EQ(SigmaCode::Kelvin(255), SigmaCode::kMax_k);
  EXPECT_TRUE(std::isnan(SigmaCode::Kelvin(0)));
}

TEST(UncertaintyBudgetTest, OnAnEvenSurfaceNoiseDriftAndResolutionAreLeft) {
  const UncertaintyBudget budget = BudgetOf(
      {.noise_k = 0.04, .drift_k = 0.03, .registration_px = 1.0, .time_s = 0.01, .voxel_m = 0.002},
      {.noise_gain = 0.25, .speed_px_s = {200.0, 0.0}, .smear_s = 0.01});
  EXPECT_NEAR(budget.noise_k, 0.02, kExact) << "four pixels averaged have half the noise";
  EXPECT_EQ(budget.drift_k, 0.03);
  EXPECT_NEAR(budget.resolution_k, kResolution_k, kSingle);
  EXPECT_EQ(budget.registration_k, 0.0);
  EXPECT_EQ(budget.footprint_k, 0.0);
  EXPECT_EQ(budget.smear_k, 0.0);
  EXPECT_NEAR(budget.Combined(), std::hypot(0.02, 0.03, kResolution_k), kSingle);
}

TEST(UncertaintyBudgetTest, ASlopeTurnsUncertainPlacesIntoKelvin) {
  const FrameUncertainty frame{.registration_px = 0.5, .time_s = 0.002, .voxel_m = 0.003};
  PixelUncertainty pixel{
      .slope_k_px = {0.6, 0.8}, .speed_px_s = {100.0, 0.0}, .smear_s = 0.01, .spot_m = 0.001};
  const UncertaintyBudget budget = BudgetOf(frame, pixel);
  // 1 K per pixel by half a pixel, and 60 K/s by 2 ms.
  EXPECT_NEAR(budget.registration_k, std::hypot(0.5, 0.12), kExact);
  // A pixel and a voxel of three pixels, evenly distributed over their widths.
  EXPECT_NEAR(budget.footprint_k, std::sqrt((1.0 + 9.0) / 12.0), kExact);
  EXPECT_NEAR(budget.smear_k, 0.6, kExact) << "60 K/s for 10 ms";
  pixel.speed_px_s = {-80.0, 60.0};
  EXPECT_NEAR(BudgetOf(frame, pixel).smear_k, 0.0, kExact) << "along what is equally warm";
  EXPECT_NEAR(BudgetOf(frame, pixel).registration_k, 0.5, kExact);
}

TEST(UncertaintyBudgetTest, BetweenHotAndHotterASlopeOfNothingIsNotCertain) {
  const FrameUncertainty frame{.registration_px = 0.3, .voxel_m = 0.002};
  const Eigen::Vector2d curvature(0.8, -0.3);
  const UncertaintyBudget budget = BudgetOf(frame, {.curvature_k_px2 = curvature, .spot_m = 0.002});
  EXPECT_EQ(budget.footprint_k, 0.0);
  // The mean square over places that lie normally around the pixel's centre, by quadrature.
  const double sigma_px = std::sqrt(0.3 * 0.3 + 2.0 / 12.0);
  double sum = 0.0, weights = 0.0;
  constexpr double kStep = 0.05;
  constexpr int kSteps = 160;  // Eight standard deviations to either side.
  for (int i = -kSteps; i <= kSteps; ++i) {
    for (int j = -kSteps; j <= kSteps; ++j) {
      const double u = kStep * i, v = kStep * j;
      const double weight = std::exp(-0.5 * (u * u + v * v));
      const double off_k =
          0.5 * sigma_px * sigma_px * (curvature.x() * u * u + curvature.y() * v * v);
      sum += weight * off_k * off_k;
      weights += weight;
    }
  }
  constexpr double kQuadrature = 1e-6;
  EXPECT_NEAR(budget.curvature_k, std::sqrt(sum / weights), kQuadrature);
}

TEST(UncertaintyBudgetTest, TheRestOfTheImagePullsAtWhatDiffersFromIt) {
  const FrameUncertainty frame{.scene_influence = 0.04, .scene_celsius = 30.0};
  EXPECT_NEAR(BudgetOf(frame, {.celsius = 130.0}).scene_k, 4.0, kExact);
  EXPECT_NEAR(BudgetOf(frame, {.celsius = 5.0}).scene_k, 1.0, kExact);
  EXPECT_EQ(BudgetOf(frame, {.celsius = 30.0}).scene_k, 0.0);
}

TEST(UncertaintyBudgetTest, EveryTermIsInTheSum) {
  for (const auto term : {&UncertaintyBudget::noise_k, &UncertaintyBudget::drift_k,
                          &UncertaintyBudget::resolution_k, &UncertaintyBudget::registration_k,
                          &UncertaintyBudget::footprint_k, &UncertaintyBudget::curvature_k,
                          &UncertaintyBudget::smear_k, &UncertaintyBudget::scene_k}) {
    UncertaintyBudget budget;
    budget.*term = 2.0;
    EXPECT_EQ(budget.Combined(), 2.0);
  }
}

TEST(DriftKelvinTest, GrowsWithTheRootOfTimeForThePatternAndWithTimeForTheHousing) {
  CameraUncertainty pattern;
  pattern.pattern_drift_k_per_sqrt_min = 0.3;
  pattern.error_per_housing_k = 0.0;
  EXPECT_EQ(DriftKelvin(pattern, {.seconds_since = 0.0}), 0.0);
  EXPECT_NEAR(DriftKelvin(pattern, {.seconds_since = 60.0}), 0.3, kExact);
  EXPECT_NEAR(DriftKelvin(pattern, {.seconds_since = 240.0}), 0.6, kExact);
  CameraUncertainty housing;
  housing.error_per_housing_k = 4.0;
  // 0.1 K a minute at most, either way.
  EXPECT_NEAR(DriftKelvin(housing, {.seconds_since = 60.0}), 0.4 / std::sqrt(3.0), kExact);
  EXPECT_NEAR(DriftKelvin(housing, {.seconds_since = 120.0}), 0.8 / std::sqrt(3.0), kExact);
  EXPECT_EQ(DriftKelvin(housing, {.seconds_since = std::nullopt, .seconds_followed = 60.0}),
            DriftKelvin(housing, {.seconds_since = 60.0}))
      << "no correction was seen";
  EXPECT_EQ(DriftKelvin(housing, {.seconds_since = 60.0, .seconds_followed = 600.0}),
            DriftKelvin(housing, {.seconds_since = 60.0}));
}

TEST(DriftKelvinTest, AHousingThatIsToldReplacesTheRate) {
  const CameraUncertainty sensor;  // 4 K per kelvin (thesis fig. 3.4b).
  EXPECT_NEAR(DriftKelvin(sensor, {.seconds_since = 600.0, .housing_change_k = -0.25}), 1.0,
              kExact);
  EXPECT_EQ(DriftKelvin(sensor, {.seconds_since = 600.0, .housing_change_k = 0.0}), 0.0);
  EXPECT_NEAR(
      DriftKelvin(sensor, {.seconds_since = 600.0, .housing_change_k = 0.0, .unseen_s = 60.0}),
      0.4 / std::sqrt(3.0), kExact)
      << "nobody saw the first minute";
  const CameraUncertainty calibrated{.left_per_housing_k = 0.2};
  EXPECT_NEAR(DriftKelvin(calibrated, {.seconds_since = 600.0, .housing_change_k = -0.25}), 0.05,
              kExact)
      << "it is taken out";
  EXPECT_EQ(DriftKelvin(calibrated, {.seconds_since = 60.0}),
            DriftKelvin(sensor, {.seconds_since = 60.0}))
      << "it cannot be: the camera does not tell";
}

TEST(ExtrinsicSigmaTest, IsTheRigsReprojectionErrorAlongOneAxis) {
  EXPECT_NEAR(ExtrinsicSigmaPx(0.5), 0.5 / std::sqrt(2.0), kExact);
  EXPECT_NEAR(ExtrinsicSigmaPx(std::nullopt), 0.0997, 1e-4) << "the thesis's rig, table 5.1";
}

}  // namespace
}  // namespace isotherm
