#pragma once

#include <filesystem>
#include <string_view>
#include <vector>

#include "common/base/status.h"
#include "common/geometry/rigid_transform.h"
#include "common/time/time_types.h"

namespace isotherm {

/// A line of a trajectory file: the pose of the depth camera in a world of the file's choice.
struct TrajectoryPose {
  CaptureTime time;
  RigidTransform T_world_depth;
};

/// TUM format: `timestamp_s tx ty tz qx qy qz qw` per line, `#` comments. Stamps must increase;
/// numbers must be finite and the quaternion of unit length. Messages name file and line.
Result<std::vector<TrajectoryPose>> ParseTrajectory(std::string_view text,
                                                    std::string_view source_name);
Result<std::vector<TrajectoryPose>> ReadTrajectory(const std::filesystem::path& path);

}  // namespace isotherm
