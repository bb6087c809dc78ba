#pragma once

#include <cstddef>

#include "common/concurrency/thread_pool.h"
#include "common/frame/image.h"
#include "ground/calibration/texture_consistency.h"
#include "ground/calibration/thermal_placement.h"
#include "ground/tsdf/tsdf_volume.h"

namespace isotherm {

/// The surface as the frame `shown` sees it, without lens distortion, each pixel with the mean of
/// some hundred thermal images that show that point, at a placement: sharp where they agree (thesis
/// fig. 5.14). °C, height x width; NaN = no surface, or seen by none. `views` has a trajectory and
/// frames.
Image<float> MeanTexture(const TsdfVolume& tsdf, const ScanViews& views,
                         const ThermalPlacement& placement, std::size_t shown, ThreadPool& pool);

/// The frame that shows most of the views' points.
std::size_t WidestFrame(const ScanViews& views);

}  // namespace isotherm
