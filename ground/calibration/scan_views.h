#pragma once

#include <filesystem>
#include <functional>

#include "common/base/status.h"
#include "ground/calibration/texture_consistency.h"

namespace isotherm {

class GroundOptions;

/// What a recording's own metadata says of delays that its stamps contain already.
struct ScanForCalibration {
  ScanViews views;
  Rig rig;                       ///< As recorded.
  double applied_delay_s = 0.0;  ///< In the thermal stamps already (an edge made the recording).
  double motion_px_s = 0.0;      ///< RMS speed of the surface in the thermal picture.
};

/// Tracks the depth camera through a recording and takes a sample of the surface and of the valid
/// thermal frames, and which points they show at all delays in [-range_s, range_s]. Fails with what
/// is missing: calibration, depth, thermal frames, poses, motion. `progress` gets the share done,
/// 0..1.
Result<ScanForCalibration> ReadScan(const std::filesystem::path& recording,
                                    const GroundOptions& options, double range_s,
                                    const std::function<void(double)>& progress);

}  // namespace isotherm
