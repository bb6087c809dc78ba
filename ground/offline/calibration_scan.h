#pragma once

#include <filesystem>
#include <functional>
#include <optional>

#include "common/base/status.h"
#include "common/rig/rig.h"
#include "ground/calibration/texture_consistency.h"

namespace isotherm {

class GroundOptions;

/// Holds what a recording offers for finding the delay of its thermal camera.
struct ScanForCalibration {
  ScanViews views;
  Rig rig;                                ///< As recorded.
  std::optional<double> applied_delay_s;  ///< See AppliedDelay.
};

/// Tracks the depth camera through a recording and takes a sample of the surface and of the valid
/// thermal frames, and which points they show at all delays in [-range_s, range_s]. Fails with what
/// is missing: calibration, depth, thermal frames, poses, motion. `progress` gets the fraction
/// done, 0..1.
Result<ScanForCalibration> ReadScan(const std::filesystem::path& recording,
                                    const GroundOptions& options, double range_s,
                                    const std::function<void(double)>& progress);

}  // namespace isotherm
