#pragma once

#include <algorithm>
#include <optional>

#include "common/time/time_types.h"

namespace isotherm {

/// Counts time by frames: as they were captured, but it never goes back. When the wall clock jumps
/// back, no time passes. Thread-compatible.
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
  /// Of the first frame; `has_begun` must hold.
  CaptureTime first() const { return *first_; }
  CaptureTime now() const { return now_; }

 private:
  std::optional<CaptureTime> first_;
  CaptureTime newest_{};  ///< Of the newest frame, as it came.
  CaptureTime now_{};
};

}  // namespace isotherm
