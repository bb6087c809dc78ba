#pragma once

#include "common/base/status.h"
#include "common/geometry/depth_of_field.h"

namespace isotherm {

/// d_min, d_th and d_max of (6.3a), metres.
struct DistanceLimits {
  double min_m;
  double good_m;
  double max_m;
};

/// A detail is this many pixels wide at the good and at the last acceptable distance. Wherever it
/// falls, one of 1 pixel fills at least half of some pixel, one of 1.5 three quarters, one of 2 a
/// whole one; the thesis advises 3 for the most accurate results (3.3.1).
struct DetailPixels {
  double good = 1.5;
  double acceptable = 1.0;
};

/// Distances at which details of `detail_m` on a surface tilted by `angle_rad` are resolved and
/// sharp. kInvalidArgument for numbers that make no sense; kFailedPrecondition if depth of field
/// and detail contradict each other, with both.
Result<DistanceLimits> LimitDistances(const DepthOfField& sharp, double ifov_rad, double detail_m,
                                      double angle_rad, const DetailPixels& pixels);

}  // namespace isotherm
