#pragma once

#include <filesystem>
#include <span>
#include <string>

#include "common/base/status.h"
#include "common/recording/recording.h"

namespace isotherm {

/// `timestamp_s tx ty tz qx qy qz qw` as in a TUM trajectory: T_world_depth, metres, nine decimals,
/// the quaternion with qw >= 0. The stamp is exact to the nanosecond. No newline; independent of
/// the locale.
std::string TumLine(const StampedPose& pose);

Status WriteTrajectory(std::span<const StampedPose> poses, const std::filesystem::path& path);

}  // namespace isotherm
