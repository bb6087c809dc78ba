#pragma once

#include <filesystem>
#include <functional>
#include <stop_token>
#include <string>
#include <string_view>

#include "common/base/status.h"
#include "ground/json/json.h"
#include "ground/options/ground_options.pb.h"
#include "ground/service/recording_tracker.h"

namespace isotherm {

/// A scan that has ended, and of which frames are not in its model or in several recordings.
struct CompletionRequest {
  const GroundOptions& options;
  std::filesystem::path folder;        ///< The scan's; its results are there.
  const RecordingProgress& recording;  ///< Closed.
  /// What the recording that is made must have at least; nothing is removed otherwise.
  std::uint64_t depth_frames = 0, thermal_frames = 0;
  std::function<void(Json&)> describe;  ///< Adds to stats.json what the recording does not know.
  std::function<void()> go_on;          ///< Called again and again while it gets on.
  std::stop_token stop;
};

/// Returns whether there is something to complete: frames came late and were recorded, or an
/// earlier process has recorded some.
bool NeedsCompletion(const GroundOptions& options, const RecordingProgress& recording);

/// Makes one recording of the files that the scan was recorded into, in the order of time, and, if
/// the model lacks more than a few frames, the results anew from it, at low priority. Returns what
/// to tell the operator. On an error, and when it is told to stop, all is as it was before: the
/// files of the recording, or the recording that was made of them.
Result<std::string> CompleteScan(const CompletionRequest& request);

}  // namespace isotherm
