#pragma once

#include <optional>

#include "common/base/mutex.h"
#include "common/base/stage_stats.h"
#include "common/messages/messages.h"
#include "edge/timestamper/time_base.h"

namespace isotherm {

/// The newest feedback from the ground, and how old the depth frames were that it is about.
/// Thread-safe.
class FeedbackMonitor {
 public:
  explicit FeedbackMonitor(TimeBase time_base) : time_base_(time_base) {}

  /// A frame is there at `now` on the wall clock. Tells how far times are shifted: the frame that
  /// took least counts as having no age.
  void NoteCapture(CaptureTime capture_time, CaptureTime now);
  /// `arrival` on the wall clock. What is about a frame that came from the recording (`is_live` is
  /// false) says nothing of how soon advice arrives.
  void Add(const Feedback& feedback, CaptureTime arrival, bool is_live = true);

  std::optional<Feedback> newest() const;
  /// Returns how old at `now` the depth frame is that the newest is about; nullopt if that is not
  /// known.
  std::optional<Nanoseconds> age(CaptureTime now) const;
  FeedbackLatency latency() const;

 private:
  /// Nullopt: times are those of a recording, at another pace.
  std::optional<Nanoseconds> AgeOf(const Feedback& feedback, CaptureTime now) const
      REQUIRES(mutex_);

  const TimeBase time_base_;
  mutable Mutex mutex_;
  /// Wall clock minus capture times.
  std::optional<Nanoseconds> shift_ GUARDED_BY(mutex_);
  std::optional<Feedback> newest_ GUARDED_BY(mutex_);
  std::uint64_t count_ GUARDED_BY(mutex_) = 0;
  StageStats latency_ GUARDED_BY(mutex_);
};

}  // namespace isotherm
