#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <stop_token>
#include <string>
#include <string_view>

#include "common/base/status.h"
#include "common/doubts/doubts.h"
#include "common/geometry/rigid_transform.h"
#include "common/radiometry/smooth_surface.h"
#include "common/rig/rig.h"
#include "ground/json/json.h"
#include "ground/offline/held_out_report.h"
#include "ground/options/ground_options.pb.h"

namespace isotherm {

/// Says what is reconstructed, and where to.
struct ReconstructRequest {
  std::filesystem::path recording;
  std::filesystem::path output_dir;
  GroundOptions options;
  std::optional<RigidTransform> initial_pose;  ///< T_world_depth of the first depth frame.
  /// A saved model to go on with; empty: a new one. Its volume replaces that of the options.
  std::filesystem::path model;
  /// Instead of the calibration in the recording.
  std::optional<Rig> rig;
  /// Adds to stats.json what the caller knows of the scan. May be empty.
  std::function<void(Json& stats)> describe;
  /// Ends it early when requested: kUnavailable, and nothing is written.
  std::stop_token stop;
  /// Called now and then with the fraction done (0..1) and what is being done.
  std::function<void(double fraction, std::string_view text)> progress;
};

/// Counts the frames of a reconstruction and says what is doubtful about it.
struct ReconstructSummary {
  std::uint64_t depth_frames = 0;
  std::uint64_t repeated_frames = 0;
  std::uint64_t tracked_frames = 0;
  std::uint64_t thermal_frames = 0;
  std::uint64_t fused_thermal_frames = 0;
  std::string text;  ///< One screen for the user.
  Doubts doubts;  ///< Why the result is not what was asked for, or the recording cannot be right.
};

/// The inline driver: one recording in, one folder of results out, the same each time. Everything
/// good in a damaged recording is used. Fails before any work if the output folder cannot be
/// written, the recording has no calibration or no depth, or an option is out of range.
Result<ReconstructSummary> Reconstruct(const ReconstructRequest& request);

/// Reconstructs without every K-th valid thermal frame, K = `every`, and predicts those. With a
/// `surface`, temperatures are predicted as they look from the angle of each view. Writes nothing;
/// `request.output_dir` is not used. Fails also if `every` is less than 2, the surface is not
/// valid, no frame is held out, or none of them has a pose.
Result<HeldOutReport> PredictHeldOutViews(const ReconstructRequest& request, int every,
                                          const std::optional<SmoothSurface>& surface);

}  // namespace isotherm
