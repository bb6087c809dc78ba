#include "edge/pipeline/feedback_monitor.h"

#include <algorithm>

#include "common/base/units.h"

namespace isotherm {

void FeedbackMonitor::NoteCapture(CaptureTime capture_time, CaptureTime now) {
  if (time_base_ != TimeBase::kShifted) return;
  const MutexLock lock(mutex_);
  // A replay's stamps are shifted into the past by a constant, and each frame is late by a little
  // more: the least difference is the shift.
  shift_ = std::min(shift_.value_or(Nanoseconds::max()), Nanoseconds(now - capture_time));
}

void FeedbackMonitor::Add(const Feedback& feedback, CaptureTime arrival, bool is_live) {
  const MutexLock lock(mutex_);
  newest_ = feedback;
  ++count_;
  if (!is_live) return;
  if (const auto age = AgeOf(feedback, arrival)) latency_.Add(kMsPerS * ToSeconds(*age));
}

std::optional<Nanoseconds> FeedbackMonitor::AgeOf(const Feedback& feedback, CaptureTime now) const {
  const Nanoseconds age = now - feedback.capture_time;
  if (time_base_ == TimeBase::kWallClock) return age;
  return shift_ ? std::optional(age - *shift_) : std::nullopt;
}

std::optional<Nanoseconds> FeedbackMonitor::age(CaptureTime now) const {
  const MutexLock lock(mutex_);
  return newest_ ? AgeOf(*newest_, now) : std::nullopt;
}

std::optional<Feedback> FeedbackMonitor::newest() const {
  const MutexLock lock(mutex_);
  return newest_;
}

FeedbackLatency FeedbackMonitor::latency() const {
  const MutexLock lock(mutex_);
  FeedbackLatency latency;
  latency.count = count_;
  if (latency_.count() == 0) return latency;
  latency.p50_s = kSPerMs * latency_.Percentile(50);
  latency.p99_s = kSPerMs * latency_.Percentile(99);
  return latency;
}

}  // namespace isotherm
