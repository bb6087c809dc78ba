#pragma once

#include <cstdint>
#include <functional>
#include <stop_token>
#include <string>
#include <vector>

#include "common/base/status.h"
#include "common/dataset/dataset.h"
#include "common/doubts/doubts.h"
#include "common/doubts/repeat_detector.h"
#include "common/frame/frame.h"
#include "common/recording/recording.h"

namespace isotherm {

/// Says which dataset becomes which recording.
struct ImportRequest {
  DatasetOptions dataset;
  std::filesystem::path recording;
  ImageStorage storage = ImageStorage::kCompact;
  bool overwrite = false;
  /// Leaves unreadable images out and counts them instead of giving up.
  bool skip_bad = false;
  std::string software;  ///< Name and version, for the metadata.
  std::function<void(double fraction)> progress;
  std::stop_token stop;  ///< Ends it early; nothing is left then.
};

/// Counts what an import wrote and left out.
struct ImportSummary {
  std::uint64_t depth_frames = 0;
  std::uint64_t thermal_frames = 0;
  std::uint64_t thermal_frames_in_nuc = 0;  ///< Recorded as invalid.
  std::uint64_t skipped_images = 0;
  std::uint64_t groundtruth_poses = 0;
  std::uint64_t external_odometry = 0;
  std::uint64_t image_bytes = 0;  ///< Raw pixels.
  std::uint64_t recording_bytes = 0;
  std::vector<std::string> notes;
  Doubts doubts;  ///< Recorded all the same, although it cannot be right.
};

/// Writes a dataset folder as one recording, in order of time. The recording is built beside its
/// final name and renamed when it is complete: after an error nothing is left and an older file is
/// untouched.
Result<ImportSummary> ImportDataset(const ImportRequest& request);

/// NUC state of thermal frames by the intervals of nuc.txt. Frames inside are in progress and
/// invalid; frames that repeat the image of such a frame bit for bit right behind it are too
/// (stamps and intervals may disagree by a frame when another stamp list is used).
/// Thread-compatible.
class NucMarker {
 public:
  explicit NucMarker(std::vector<NucInterval> intervals) : intervals_(std::move(intervals)) {}
  /// Frames in order of time. Sets nuc_state, nuc_source, seconds_since_nuc and valid.
  void Mark(ThermalFrame& frame);

 private:
  std::vector<NucInterval> intervals_;
  std::size_t next_ = 0;  ///< First interval that has not ended.
  std::optional<CaptureTime> last_end_;
  RepeatDetector repeats_;
  bool was_marked_ = false;  ///< The frame before.
};

}  // namespace isotherm
