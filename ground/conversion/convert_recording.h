#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <stop_token>
#include <string>
#include <string_view>
#include <vector>

#include "common/base/status.h"
#include "common/geometry/stamped_pose.h"
#include "common/recording/recording.h"
#include "common/simulation/depth_defects.h"
#include "ground/conversion/merged_recording.h"

namespace isotherm {

/// Metadata of a recording whose images were made worse on purpose: what was done, by stream.
inline constexpr std::string_view kSpoiledMetadata = "spoiled";

/// Says which recording becomes which.
struct ConvertRequest {
  std::filesystem::path recording;
  /// Further recordings of the same scan, which fill holes (MergedRecording).
  std::vector<std::filesystem::path> others;
  std::filesystem::path output;  ///< Must not exist.
  ImageStorage storage = ImageStorage::kViewable;
  /// T_world_depth, in order of time. Empty: viewable recordings get those that the recording
  /// itself has, of a reconstruction or of the ground's feedback.
  std::vector<StampedPose> poses;
  DepthDefect defect = DepthDefect::kNone;  ///< Done to each depth image.
  bool sync = false;  ///< All is on the disk when it returns, so that the old one may go.
  std::function<void(double fraction)> progress;
  std::stop_token stop;
};

/// Counts what was converted.
struct ConvertSummary {
  std::uint64_t depth_frames = 0;
  std::uint64_t thermal_frames = 0;
  std::uint64_t poses = 0;        ///< Poses of the rig, written as transforms.
  std::string poses_from;         ///< Where they come from, in words.
  std::uint64_t left_out = 0;     ///< Damaged messages.
  std::vector<MergedPart> parts;  ///< Where the frames come from, if there are others.
  std::uint64_t missing = 0;      ///< Frames that none of these has.
  bool has_thermal_pose = false;  ///< T_thermal_depth is there as a transform.
};

/// Writes the recording anew with its images stored otherwise; frames, times and everything else
/// that was recorded stay what they are, but for the defect that is asked for: the new recording's
/// metadata say so (kSpoiledMetadata).
Result<ConvertSummary> ConvertRecording(const ConvertRequest& request);

}  // namespace isotherm
