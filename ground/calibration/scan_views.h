#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <vector>

#include "common/base/status.h"
#include "common/concurrency/thread_pool.h"
#include "common/rig/rig.h"
#include "ground/calibration/texture_consistency.h"
#include "ground/tsdf/tsdf_volume.h"

namespace isotherm {

class GroundOptions;
struct RecordingInfo;
struct ScanModel;

/// Adds the certain poses of `scan` and up to `max_points` points of its surface (in `world`) to
/// thermal frames, and which of them the frames show at all delays in [-range_s,
/// range_s]. Fails with what is missing: frames, surface, motion. `progress` gets the fraction
/// done, 0..1.
Status AddSurface(const ScanModel& scan, std::size_t max_points, double range_s, ThreadPool& pool,
                  ScanViews& views, const std::function<void(double)>& progress);

/// The delay that a recording's thermal stamps contain already: that of the edge that made it, in
/// seconds; 0 for other recordings; nullopt if it was made by the ground, which is not told.
std::optional<double> AppliedDelay(const RecordingInfo& info);

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
