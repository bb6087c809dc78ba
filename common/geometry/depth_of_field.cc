#include "common/geometry/depth_of_field.h"

#include <cmath>
#include <limits>

#include "common/base/check.h"

namespace isotherm {

DepthOfField ComputeDepthOfField(double focal_length_m, double f_number, double circle_m,
                                 double focus_m) {
  CHECK(focal_length_m > 0.0 && f_number > 0.0 && circle_m > 0.0 && focus_m > focal_length_m);
  // Symbols as in (2.20): D, f, N, c; the circle term is c N (D - f).
  const double D = focus_m;
  const double f2 = focal_length_m * focal_length_m;
  const double circle_term = circle_m * f_number * (D - focal_length_m);
  const bool ends = f2 > circle_term;
  return {D * f2 / (f2 + circle_term),
          ends ? D * f2 / (f2 - circle_term) : std::numeric_limits<double>::infinity()};
}

double HyperfocalDistance(double focal_length_m, double f_number, double circle_m) {
  return focal_length_m * focal_length_m / (circle_m * f_number) + focal_length_m;
}

PixelFootprint FootprintOfPixel(double ifov_rad, double distance_m, double angle_rad) {
  const double across_m = ifov_rad * distance_m;
  return {across_m, across_m / std::cos(angle_rad)};
}

}  // namespace isotherm
