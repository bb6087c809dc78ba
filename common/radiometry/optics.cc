#include "common/radiometry/optics.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "common/base/check.h"

namespace isotherm {

DepthOfField ComputeDepthOfField(double focal_length_m, double f_number, double circle_m,
                                 double focus_m) {
  CHECK(focal_length_m > 0.0 && f_number > 0.0 && circle_m > 0.0 && focus_m > focal_length_m);
  // Symbols as in (2.20): D, f, N, c.
  const double D = focus_m;
  const double f2 = focal_length_m * focal_length_m;
  const double cND = circle_m * f_number * (D - focal_length_m);
  return {D * f2 / (f2 + cND),
          f2 > cND ? D * f2 / (f2 - cND) : std::numeric_limits<double>::infinity()};
}

double HyperfocalDistance(double focal_length_m, double f_number, double circle_m) {
  return focal_length_m * focal_length_m / (circle_m * f_number) + focal_length_m;
}

PixelFootprint FootprintOfPixel(double ifov_rad, double distance_m, double angle_rad) {
  const double across_m = ifov_rad * distance_m;
  return {across_m, across_m / std::cos(angle_rad)};
}

Result<DistanceLimits> LimitDistances(const DepthOfField& sharp, double ifov_rad, double detail_m,
                                      double angle_rad, const DetailPixels& pixels) {
  if (!(detail_m > 0.0 && ifov_rad > 0.0 && angle_rad >= 0.0 && angle_rad < std::numbers::pi / 2.0))
    return Err(InvalidArgument("detail size and pixel angle must be positive, angles below 90"));
  if (!(pixels.acceptable >= 1.0 && pixels.good >= pixels.acceptable)) {
    return Err(InvalidArgument(
        fmt::format("a detail must be at least 1 pixel wide, and a good one at least as wide as an "
                    "acceptable one, got {} and {}",
                    pixels.acceptable, pixels.good)));
  }
  if (!(sharp.near_m >= 0.0 && sharp.far_m > sharp.near_m)) {
    return Err(
        InvalidArgument(fmt::format("the near limit must be below the far limit, got {} m and {} m",
                                    sharp.near_m, sharp.far_m)));
  }
  const double one_pixel_m = detail_m / FootprintOfPixel(ifov_rad, 1.0, angle_rad).along_m;
  const DistanceLimits limits{sharp.near_m, std::min(sharp.far_m, one_pixel_m / pixels.good),
                              std::min(sharp.far_m, one_pixel_m / pixels.acceptable)};
  if (limits.good_m <= limits.min_m) {
    return Err(FailedPrecondition(fmt::format(
        "the limits contradict each other: details of {:.1f} mm are resolved up to {:.3f} m, and "
        "nearer than {:.3f} m they are blurred; focus nearer, or accept larger details",
        detail_m * 1e3, limits.good_m, limits.min_m)));
  }
  return limits;
}

}  // namespace isotherm
