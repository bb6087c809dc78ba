#pragma once

#include <filesystem>
#include <string_view>
#include <vector>

#include "common/base/status.h"
#include "common/geometry/stamped_pose.h"

namespace isotherm {

/// TUM format: `timestamp_s tx ty tz qx qy qz qw` per line, `#` comments. Stamps must increase;
/// numbers must be finite and the quaternion of unit length. Messages name file and line.
Result<std::vector<StampedPose>> ParseTrajectory(std::string_view text,
                                                 std::string_view source_name);
Result<std::vector<StampedPose>> ReadTrajectory(const std::filesystem::path& path);

}  // namespace isotherm
