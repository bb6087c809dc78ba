#pragma once

#include <optional>

#include "common/time/time_types.h"
#include "common/transport/qos.h"

namespace isotherm {

/// Says how long publishing may go on once it was told to stop, over all frames together. The time
/// runs from the first question on. Thread-compatible.
class StopBudget {
 public:
  /// This long the ground may take to make room in the flow window.
  static constexpr Nanoseconds kWaiting = std::chrono::milliseconds(500);
  /// This long writing may go on: without its peer, the middleware makes each write wait.
  static constexpr Nanoseconds kWriting = std::chrono::milliseconds(700);
  static_assert(kWaiting < kWriting, "what was waited for is written");
  /// From the stop to the end of the last write: one may block when stop is requested, before
  /// anybody asks, and one that is begun at the last moment may block as well.
  static constexpr Nanoseconds kMaxTotal = kWriting + 2 * kMaxFrameBlocking;

  bool MayWait(SteadyTime now) { return now < Begin(now) + kWaiting; }
  bool MayWrite(SteadyTime now) { return now < Begin(now) + kWriting; }

 private:
  SteadyTime Begin(SteadyTime now) {
    if (!stopped_at_) stopped_at_ = now;
    return *stopped_at_;
  }

  std::optional<SteadyTime> stopped_at_;
};

}  // namespace isotherm
