#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

#include "common/base/status.h"
#include "common/geometry/stamped_pose.h"
#include "common/recording/recording.h"

/// This header names a recording's messages for those who copy them without unpacking them.
namespace isotherm::recording {

/// Start of the year 2100: later times are damage.
inline constexpr std::int64_t kMaxRecordedNanoseconds = 4'102'444'800'000'000'000;

inline constexpr std::string_view kDepthTopic = "/depth";
inline constexpr std::string_view kThermalTopic = "/thermal";
inline constexpr std::string_view kRigTopic = "/rig";
inline constexpr std::string_view kDepthInfoTopic = "/depth/camera_info";
inline constexpr std::string_view kThermalInfoTopic = "/thermal/camera_info";
inline constexpr std::string_view kThermalPoseTopic = "/thermal/transform";
inline constexpr std::string_view kNucTopic = "/nuc";
inline constexpr std::string_view kClockTopic = "/clock";
inline constexpr std::string_view kGroundtruthTopic = "/groundtruth";
inline constexpr std::string_view kTrajectoryTopic = "/trajectory";
inline constexpr std::string_view kExternalOdometryTopic = "/external_odometry";
/// kExternalOdometryTopic was called so before, and is still read under this name.
inline constexpr std::string_view kOldOdometryTopic = "/outside_pose";
inline constexpr std::string_view kLogTopic = "/log";

/// The pose of the depth camera that a message of feedback carries; nullopt while the rig was lost,
/// or if the message is damaged.
std::optional<StampedPose> TrackedPoseIn(std::string_view feedback_message);

/// True pose of the depth camera, as that of another coordinate frame than the depth camera's.
Status WriteGroundtruth(std::string_view frame, const StampedPose& pose, RecordingWriter& writer);

}  // namespace isotherm::recording
