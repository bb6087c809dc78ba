#pragma once

#include <mutex>
#include <optional>

#include "common/base/stage_stats.h"
#include "common/messages/messages.h"
#include "edge/pipeline/time_base.h"

namespace isotherm {

/// The newest feedback from the ground, and how old the depth frames were that it is about.
/// Thread-safe.
class FeedbackMonitor {
 public:
  explicit FeedbackMonitor(TimeBase time_base) : time_base_(time_base) {}

  /// A frame is there at `now` on the wall clock. Tells how far times are shifted: the frame that
  /// took least counts as having no age.
  void NoteCapture(CaptureTime capture_time, CaptureTime now);
  /// `arrival` on the wall clock.
  void Add(const Feedback& feedback, CaptureTime arrival);

  std::optional<Feedback> newest() const;
  FeedbackLatency latency() const;

 private:
  const TimeBase time_base_;
  mutable std::mutex mutex_;          // Guards what follows.
  std::optional<Nanoseconds> shift_;  ///< Wall clock minus capture times.
  std::optional<Feedback> newest_;
  std::uint64_t count_ = 0;
  StageStats latency_;
};

}  // namespace isotherm
