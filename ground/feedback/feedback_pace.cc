#include "ground/feedback/feedback_pace.h"

#include "common/base/units.h"

namespace isotherm {

void FeedbackPace::Add(const FrameHeader& header, const DepthReport& report) {
  if (report.repeated) return;
  const CaptureTime time = header.capture_time;
  NoteMotion(report, time);
  moment_.report = report;
  moment_.header = header;
  if (next_ && time < *next_) return;
  is_due_ = true;
  // From the deadline before, so that jitter does not lower the rate; after a gap, from now.
  const CaptureTime due = next_.value_or(time) + period_;
  next_ = due > time ? due : time + period_;
}

void FeedbackPace::NoteMotion(const DepthReport& report, CaptureTime time) {
  if (!since_) {
    since_ = time;
    return;
  }
  ++frames_;
  if (report.tracked) {
    path_m_ += report.tracking.step_m;
    rotated_rad_ += report.tracking.step_rad;
  }
  const double elapsed_s = ToSeconds(time - *since_);
  if (elapsed_s <= 0.0) return;
  moment_.speed_m_s = path_m_ / elapsed_s;
  moment_.rotation_rate_deg_s = rotated_rad_ / kRadPerDeg / elapsed_s;
  moment_.frame_interval_s = elapsed_s / frames_;
}

std::optional<FeedbackMoment> FeedbackPace::Take() {
  if (!is_due_) return std::nullopt;
  is_due_ = false;
  since_ = moment_.header.capture_time;
  path_m_ = 0.0;
  rotated_rad_ = 0.0;
  frames_ = 0;
  return moment_;
}

}  // namespace isotherm
