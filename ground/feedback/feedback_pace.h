#pragma once

#include <optional>

#include "common/frame/frame.h"
#include "ground/feedback/feedback_maker.h"
#include "ground/scan/depth_report.h"

namespace isotherm {

/// Says when a message of feedback is due, by capture time, and how the rig moved since the message
/// before. Thread-compatible.
class FeedbackPace {
 public:
  /// `feedback_hz` > 0.
  explicit FeedbackPace(double feedback_hz) : period_(FromSeconds(1.0 / feedback_hz)) {}

  /// Takes what became of a depth frame. A repeated one says nothing new.
  void Add(const FrameHeader& header, const DepthReport& report);
  /// Takes whether the thermal camera is about to correct itself, does, or settles.
  void set_nuc_running(bool nuc_running) { moment_.nuc_running = nuc_running; }

  /// Returns what the message that is due is about; nullopt if none is.
  std::optional<FeedbackMoment> Take();

 private:
  void NoteMotion(const DepthReport& report, CaptureTime time);

  const Nanoseconds period_;
  FeedbackMoment moment_;  ///< The newest depth frame's.
  bool is_due_ = false;
  std::optional<CaptureTime> next_;
  std::optional<CaptureTime> since_;  ///< Time of the last frame before those summed up here.
  double path_m_ = 0.0;
  double rotated_rad_ = 0.0;
  int frames_ = 0;
};

}  // namespace isotherm
