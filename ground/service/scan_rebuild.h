#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <vector>

#include "common/frame/frame.h"
#include "common/geometry/external_odometry.h"
#include "common/recording/recording.h"
#include "common/time/clock.h"
#include "ground/conversion/merged_recording.h"
#include "ground/service/live_scan.h"
#include "ground/service/session_item.h"
#include "ground/subscriber/subscriber.h"

namespace isotherm {

/// Brings what an earlier process has recorded of a session into this one, a little at a time:
///   1. which frames there are, so that the rig does not send them again,
///   2. these frames, in the order of time, into the model.
/// Recordings of another session are left alone. What cannot be read is logged and left out.
/// Thread-bound to the reconstruction thread.
class ScanRebuild {
 public:
  /// `start` has the files; those that are of its session go into its recording's progress.
  /// `subscriber` and `scan` must outlive the rebuild. Without a scan the rig is told, and no model
  /// is made.
  ScanRebuild(const SessionStart& start, const Clock& clock, Subscriber& subscriber,
              LiveScan* scan);

  /// Looks which of the files are of the session, before any frame is left out because of them.
  /// Returns false if none is.
  bool Begin();
  /// Does a few milliseconds' work. Returns false when nothing is left to do.
  bool Step();
  /// A frame came that has no place in the model, which is not as far yet.
  void CountLeftOut() {
    ++report_.left_out;
    Report();
  }
  /// The same for a pose: it is recorded, and the next ones are counted from here.
  void CountLeftOut(const ExternalOdometrySample& sample) { scan_->SkipPosesTo(sample.number + 1); }
  /// Returns the part of what was recorded that is in the model, 0..1.
  double fraction() const {
    return recorded_frames_ == 0
               ? 0.0
               : static_cast<double>(report_.frames) / static_cast<double>(recorded_frames_);
  }

 private:
  /// Takes the next items of a file, and notes their numbers. Returns false at the last file's end.
  bool Survey();
  void EndFile(bool is_of_session);
  /// Returns whether the first frame of a file is of the session.
  bool IsOfSession(const std::filesystem::path& file) const;
  void Note(Sensor sensor, const FrameHeader& header);
  void Send(Sensor sensor);
  void BeginModel();
  bool Rebuild();
  /// Tells the scan how far it has come.
  void Report();
  // What the recording gives.
  void Take(const RecordedDepth& depth);
  void Take(const RecordedThermal& thermal);
  void Take(const ExternalOdometry& pose) { scan_->AddRecorded(pose); }
  template <typename Item>
  void Take(const Item& /*other*/) {}

  const std::uint64_t session_;
  const std::shared_ptr<RecordingTracker> recording_;
  const Clock& clock_;
  Subscriber& subscriber_;
  LiveScan* const scan_;
  const SteadyTime begun_;
  std::vector<std::filesystem::path> files_;  ///< Others are left out once looked at.
  std::size_t next_file_ = 0;
  std::unique_ptr<RecordingReader> reader_;  ///< Reads a file to look it through.
  std::unique_ptr<MergedRecording> all_;     ///< All of them, while they go into the model.
  bool is_survey_ = true;
  std::uint64_t frames_in_file_ = 0;
  std::array<std::vector<RecordedNumbers::Frame>, 2> frames_;  ///< By Sensor: not yet told.
  std::uint64_t recorded_frames_ = 0;
  RebuildReport report_;
};

}  // namespace isotherm
