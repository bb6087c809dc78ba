#include "ground/limits/distance_limits.h"

#include <gtest/gtest.h>

#include <cmath>

#include "common/base/units.h"

namespace isotherm {
namespace {

// A microbolometer camera of the size of the thesis's: 10 mm f/1, 25 um pitch.
constexpr double kFocal = 0.010, kFNumber = 1.0, kPitch = 25e-6;

/// Diameter of the spot on the detector behind a thin lens that is focused at `focus`, from an
/// object at `distance` (2.19 and similar triangles).
double BlurCircle(double focal, double f_number, double focus, double distance) {
  const auto image = [&](double d) { return focal * d / (d - focal); };
  return focal / f_number * std::abs(image(distance) - image(focus)) / image(distance);
}

TEST(DepthOfFieldTest, LimitsAreWhereTheBlurCircleFillsOneElement) {
  for (const double focus : {0.1, 0.5, 2.0}) {
    const DepthOfField field = ComputeDepthOfField(kFocal, kFNumber, kPitch, focus);
    EXPECT_NEAR(BlurCircle(kFocal, kFNumber, focus, field.near_m), kPitch, 1e-12);
    EXPECT_NEAR(BlurCircle(kFocal, kFNumber, focus, field.far_m), kPitch, 1e-12);
    EXPECT_LT(field.near_m, focus);
    EXPECT_GT(field.far_m, focus);
  }
}

TEST(DepthOfFieldTest, LiesEvenlyAboutTheFocusInReciprocalDistance) {
  const DepthOfField field = ComputeDepthOfField(kFocal, kFNumber, kPitch, 0.5);
  EXPECT_NEAR(1.0 / field.near_m + 1.0 / field.far_m, 2.0 / 0.5, 1e-9);
}

TEST(DepthOfFieldTest, DepthIsThatOfTheThesis) {
  // (2.20c).
  const double D = 0.5, f2 = kFocal * kFocal, cND = kPitch * kFNumber * (D - kFocal);
  const DepthOfField field = ComputeDepthOfField(kFocal, kFNumber, kPitch, D);
  EXPECT_NEAR(field.far_m - field.near_m, 2.0 * D * f2 * cND / (f2 * f2 - cND * cND), 1e-12);
}

TEST(DepthOfFieldTest, BeyondTheHyperfocalDistanceItHasNoEnd) {
  const double hyperfocal = HyperfocalDistance(kFocal, kFNumber, kPitch);
  EXPECT_NEAR(hyperfocal, 4.01, 1e-9);
  EXPECT_TRUE(std::isinf(ComputeDepthOfField(kFocal, kFNumber, kPitch, hyperfocal * 1.0001).far_m));
  EXPECT_FALSE(
      std::isinf(ComputeDepthOfField(kFocal, kFNumber, kPitch, hyperfocal * 0.9999).far_m));
  EXPECT_NEAR(ComputeDepthOfField(kFocal, kFNumber, kPitch, hyperfocal).near_m, hyperfocal / 2.0,
              1e-9);
}

TEST(FootprintTest, GrowsWithDistanceAndWithTilt) {
  // Optris PI 450: 1.1 mm at 0.5 m and 2.3 mm at 1 m (thesis 3.3.1).
  constexpr double kPublishedRounding = 0.05e-3;
  constexpr double kIfov_rad = 2.25e-3;
  EXPECT_NEAR(FootprintOfPixel(kIfov_rad, 0.5, 0.0).across_m, 1.1e-3, kPublishedRounding);
  EXPECT_NEAR(FootprintOfPixel(kIfov_rad, 1.0, 0.0).across_m, 2.3e-3, kPublishedRounding + 1e-12);
  const PixelFootprint tilted = FootprintOfPixel(kIfov_rad, 1.0, 60.0 * kRadPerDeg);
  EXPECT_NEAR(tilted.across_m, 2.25e-3, 1e-12);
  EXPECT_NEAR(tilted.along_m, 4.5e-3, 1e-12);
}

TEST(LimitDistancesTest, DetailsAreAsManyPixelsWideAsAskedFor) {
  const DepthOfField field{0.2, 3.0};
  const auto limits = LimitDistances(field, 0.0025, 0.003, 0.0, {3.0, 2.0});
  ASSERT_TRUE(limits);
  EXPECT_EQ(limits->min_m, 0.2);
  EXPECT_NEAR(0.003 / FootprintOfPixel(0.0025, limits->good_m, 0.0).along_m, 3.0, 1e-9);
  EXPECT_NEAR(0.003 / FootprintOfPixel(0.0025, limits->max_m, 0.0).along_m, 2.0, 1e-9);
  const auto tilted = LimitDistances(field, 0.0025, 0.003, 45.0 * kRadPerDeg, {3.0, 2.0});
  EXPECT_NEAR(0.003 / FootprintOfPixel(0.0025, tilted->max_m, 45.0 * kRadPerDeg).along_m, 2.0,
              1e-9);
}

TEST(LimitDistancesTest, BlurEndsBothRanges) {
  const auto limits = LimitDistances({0.2, 0.3}, 0.0025, 0.003, 0.0, {3.0, 2.0});
  ASSERT_TRUE(limits);
  EXPECT_EQ(limits->good_m, 0.3);
  EXPECT_EQ(limits->max_m, 0.3);
}

TEST(LimitDistancesTest, ContradictionsAreSaidWithBothDistances) {
  const auto blurred = LimitDistances({0.5, 3.0}, 0.0025, 0.003, 0.0, {3.0, 2.0});
  EXPECT_EQ(blurred.error().code(), StatusCode::kFailedPrecondition);
  EXPECT_NE(blurred.error().message().find("0.400 m"), std::string::npos);
  EXPECT_NE(blurred.error().message().find("0.500 m"), std::string::npos);
  EXPECT_EQ(LimitDistances({0.5, 0.4}, 0.0025, 0.003, 0.0, {3.0, 2.0}).error().code(),
            StatusCode::kInvalidArgument);
  EXPECT_EQ(LimitDistances({0.2, 1.0}, 0.0025, 0.003, 0.0, {2.0, 3.0}).error().code(),
            StatusCode::kInvalidArgument);
  EXPECT_EQ(LimitDistances({0.2, 1.0}, 0.0025, -0.003, 0.0, {3.0, 2.0}).error().code(),
            StatusCode::kInvalidArgument);
  EXPECT_EQ(LimitDistances({0.2, 1.0}, 0.0025, 0.003, 90.0 * kRadPerDeg, {}).error().code(),
            StatusCode::kInvalidArgument);
}

}  // namespace
}  // namespace isotherm
