#pragma once

#include <cstdint>
#include <deque>
#include <optional>

#include "common/frame/frame.h"

namespace isotherm {

/// Keeps when the shutter closed and opened, and how much of the last minute it was closed.
/// Thread-compatible.
class ShutterLog {
 public:
  /// `closed_by`: how a closed shutter is known; nullopt = it is open. `time` must not decrease
  /// between calls.
  void Update(CaptureTime time, std::optional<NucSource> closed_by);

  bool is_closed() const { return closed_at_.has_value(); }
  bool just_closed() const { return just_closed_; }
  bool just_opened() const { return just_opened_; }
  /// Returns who noticed or ordered the newest closing; kUnknown before the first.
  NucSource source() const { return source_; }
  /// Returns for how long it has been closed or, when it is open, was closed the last time.
  Nanoseconds closed_for() const { return closed_for_; }
  std::optional<CaptureTime> opened_at() const { return opened_at_; }

  /// Closings in the last minute.
  int closings_per_minute() const { return static_cast<int>(last_minute_.size()); }
  /// Fraction of the last minute, or of the time since the first frame if that is shorter.
  double closed_fraction() const;
  std::uint64_t closings() const { return closings_; }  ///< In all.

 private:
  /// Spans the time from the shutter's closing to its opening.
  struct Closing {
    CaptureTime start, end;
  };

  CaptureTime now_{};
  std::optional<CaptureTime> first_frame_;
  std::optional<CaptureTime> closed_at_;  ///< While it is closed.
  std::optional<CaptureTime> opened_at_;  ///< Last time.
  Nanoseconds closed_for_{0};
  bool just_closed_ = false;
  bool just_opened_ = false;
  NucSource source_ = NucSource::kUnknown;
  std::uint64_t closings_ = 0;
  std::deque<Closing> last_minute_;
};

}  // namespace isotherm
