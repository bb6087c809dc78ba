#pragma once

#include <cstddef>
#include <filesystem>
#include <vector>

#include "common/base/status.h"
#include "common/frame/frame.h"
#include "common/geometry/stamped_pose.h"
#include "common/rig/rig.h"

namespace isotherm {

/// Frames to measure with, decoded and in order of time.
struct BenchmarkFrames {
  Rig rig;
  std::vector<DepthFrame> depth;
  std::vector<ThermalFrame> thermal;
  std::vector<StampedPose> truth;  ///< True T_world_depth at depth frames; empty if not known.
};

/// The first frames of the simulated furnace door scan, always the same. Rendered once per process.
const BenchmarkFrames& FurnaceDoorFrames();

/// Depth frames of a recording (.mcap) or of a dataset folder, at most `max_frames` (0 = all), with
/// the ground truth in it. No thermal frames.
Result<BenchmarkFrames> LoadDepthFrames(const std::filesystem::path& scan, std::size_t max_frames);

}  // namespace isotherm
