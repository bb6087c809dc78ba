#pragma once

#include <algorithm>
#include <optional>

#include "common/time/time_types.h"

namespace isotherm {

/// Counts time by the capture times of frames, but never goes back: when the wall clock jumps back,
/// no time passes. Thread-compatible.
class FrameClock {
 public:
  /// Advances to a frame captured at `time`, and returns what has passed since the one before.
  Nanoseconds Advance(CaptureTime time) {
    if (!first_) first_ = now_ = newest_ = time;
    const Nanoseconds passed = std::max(Nanoseconds(0), Nanoseconds(time - newest_));
    newest_ = time;
    now_ += passed;
    return passed;
  }

  bool has_begun() const { return first_.has_value(); }
  /// Returns when the first frame was captured; `has_begun` must hold.
  CaptureTime first() const { return *first_; }
  CaptureTime now() const { return now_; }

 private:
  std::optional<CaptureTime> first_;
  CaptureTime newest_{};  ///< When the newest frame was captured, by the wall clock.
  CaptureTime now_{};
};

}  // namespace isotherm
