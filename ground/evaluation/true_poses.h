#pragma once

#include <filesystem>
#include <vector>

#include "common/base/status.h"
#include "common/geometry/stamped_pose.h"

namespace isotherm {

/// True poses from a trajectory file in TUM format, or from the ground truth inside a recording
/// (.mcap).
Result<std::vector<StampedPose>> ReadTruePoses(const std::filesystem::path& path);

/// The pose at `time`, interpolated between its neighbours; up to 50 ms beyond the ends the pose
/// there.
Result<RigidTransform> PoseAt(const std::vector<StampedPose>& poses, CaptureTime time);

/// Capture time of the first depth frame.
Result<CaptureTime> FirstDepthTime(const std::filesystem::path& recording);

/// Capture times of depth frames whose image is bit for bit that of the frame before.
Result<std::vector<CaptureTime>> RepeatedDepthFrames(const std::filesystem::path& recording);

}  // namespace isotherm
