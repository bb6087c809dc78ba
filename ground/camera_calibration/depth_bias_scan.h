#pragma once

#include <filesystem>
#include <functional>
#include <optional>

#include "common/base/status.h"
#include "common/rig/rig.h"
#include "ground/camera_calibration/depth_bias_fit.h"

namespace isotherm {

/// Finds the depth camera's bias from a recording of a flat wall (DepthBiasFit). `rig` replaces the
/// recording's own calibration, and is set to the one that was used. `progress` gets the fraction
/// done, 0..1.
Result<DepthBiasReport> FindDepthBias(const std::filesystem::path& recording,
                                      std::optional<Rig>& rig,
                                      const std::function<void(double)>& progress);

}  // namespace isotherm
