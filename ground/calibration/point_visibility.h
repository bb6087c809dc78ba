#pragma once

#include "common/concurrency/thread_pool.h"
#include "ground/calibration/texture_consistency.h"
#include "ground/tsdf/tsdf_volume.h"

namespace isotherm {

/// Fills StampedThermal::visible: the points that the thermal camera sees from all poses of the
/// trajectory within `range_s` of the picture's stamp, clear of silhouettes and not too obliquely.
/// The surface of `tsdf` (in the trajectory's `world`) decides, cast once from each pose.
void FindVisiblePoints(const TsdfVolume& tsdf, double range_s, ThreadPool& pool, ScanViews& views);

}  // namespace isotherm
