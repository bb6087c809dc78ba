#include "common/radiometry/smooth_surface.h"

#include <gmock/gmock.h>

#include <cmath>
#include <limits>

#include "common/base/units.h"

namespace isotherm {
namespace {

constexpr double kThereAndBack_k = 2e-3;  // What BandRadiance promises, twice.
constexpr SmoothSurface kPaint{
    .normal_emissivity = 0.96, .refractive_index = 1.5, .reflected_celsius = 23.0};

TEST(SmoothSurfaceTest, WhatIsSeenAtAnAngleTellsWhatIsSeenAtAnother) {
  const BandRadiance band;
  for (const double true_celsius : {-20.0, 60.0, 280.0}) {
    const auto apparent = [&](double angle_rad) {
      return ApparentCelsius(band, true_celsius, DirectionalEmissivity(angle_rad, 0.96, 1.5, 0.0),
                             23.0);
    };
    for (const double from_deg : {0.0, 30.0, 65.0}) {
      for (const double to_deg : {0.0, 45.0, 80.0}) {
        EXPECT_NEAR(ApparentAtAngle(band, kPaint, apparent(from_deg * kRadPerDeg),
                                    from_deg * kRadPerDeg, to_deg * kRadPerDeg),
                    apparent(to_deg * kRadPerDeg), kThereAndBack_k)
            << true_celsius << " from " << from_deg << " to " << to_deg;
      }
    }
  }
}

TEST(SmoothSurfaceTest, WhatCannotBeMeasuredStaysUnknown) {
  const BandRadiance band;
  EXPECT_TRUE(std::isnan(ApparentAtAngle(band, kPaint, NAN, 0.0, 1.0)));
}

TEST(SmoothSurfaceTest, RefusesWhatNoSurfaceHas) {
  EXPECT_TRUE(Validate(kPaint).ok());
  for (const SmoothSurface& wrong :
       {SmoothSurface{.normal_emissivity = 0.0}, SmoothSurface{.normal_emissivity = 1.01},
        SmoothSurface{.normal_emissivity = NAN}, SmoothSurface{.refractive_index = 0.9},
        SmoothSurface{.refractive_index = NAN}, SmoothSurface{.extinction_coefficient = -1.0},
        SmoothSurface{.extinction_coefficient = NAN}, SmoothSurface{.reflected_celsius = -101.0},
        SmoothSurface{.reflected_celsius = std::numeric_limits<double>::infinity()}}) {
    EXPECT_EQ(Validate(wrong).code(), StatusCode::kInvalidArgument);
  }
}

}  // namespace
}  // namespace isotherm
