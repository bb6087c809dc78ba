#pragma once

#include <cstddef>
#include <functional>
#include <stop_token>
#include <vector>

#include "common/concurrency/thread_pool.h"
#include "ground/calibration/texture_consistency.h"
#include "ground/tsdf/tsdf_volume.h"

namespace isotherm {

/// Draws up to `max_points` points of the surface of `tsdf` (in the trajectory's `world`) as the
/// thermal camera sees it from poses of the frames, so that the time this takes does not grow with
/// the surface. In random order that is always the same.
std::vector<TexturePoint> DrawPoints(const TsdfVolume& tsdf, const ScanViews& views,
                                     std::size_t max_points, ThreadPool& pool);

/// Fills StampedThermal::visible: the points that the thermal camera sees from all poses of the
/// trajectory within `range_s` of the image's stamp, clear of silhouettes and not too obliquely.
/// The surface of `tsdf` (in the trajectory's `world`) decides, cast from poses a few hundredths of
/// a second apart. `progress` gets the fraction done, 0..1. Gives up soon after `stop` was
/// requested; the frames that are left show nothing.
void FindVisiblePoints(const TsdfVolume& tsdf, double range_s, ThreadPool& pool, ScanViews& views,
                       const std::function<void(double)>& progress,
                       const std::stop_token& stop = {});

}  // namespace isotherm
