#include "ground/limits/distance_limits.h"

#include <fmt/format.h>

#include <algorithm>
#include <numbers>

namespace isotherm {

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
