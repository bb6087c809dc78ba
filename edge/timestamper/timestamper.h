#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <vector>

#include "common/time/time_types.h"

namespace isotherm {

/// Capture time with its one-sigma uncertainty; 0 = not estimated yet.
struct Stamp {
  CaptureTime time;
  Nanoseconds sigma{0};
};

/// Relates one camera's ticks to the edge's wall clock: the differences arrival - ticks go through
/// a median filter of length N, and the filtered difference is added back to the ticks, plus a
/// constant delay (Ordonez Müller, *Close range 3D thermography*, eq. 5.4 and 5.5).
///
///   warm-up   the first N - 1 frames use the median of the differences seen so far, the first one
///   its own reset     ticks that go backwards are a new counter: the filter starts again from that
///   frame output    strictly increasing; what would not be is moved 1 ns behind the stamp before,
///   and counted
///
/// The sigma is the standard error of the median, from the spread (MAD) in the window: random error
/// only, without the constant transport delay and without drift. Pure: no clock inside.
/// Thread-compatible.
class Timestamper {
 public:
  /// `window` >= 1 frames.
  Timestamper(int window, Nanoseconds constant_delay);

  Stamp Process(DeviceTicks ticks, CaptureTime arrival);

  /// Counter resets seen, and stamps that had to be moved to stay increasing.
  std::uint64_t resets() const { return resets_; }
  std::uint64_t moved() const { return moved_; }

 private:
  void AddDifference(Nanoseconds difference);
  Nanoseconds Median() const;
  Nanoseconds Sigma(Nanoseconds median) const;

  const std::size_t window_;
  const Nanoseconds constant_delay_;
  std::deque<Nanoseconds> differences_;  ///< In order of arrival.
  std::vector<Nanoseconds> sorted_;      ///< The same, ascending.
  std::optional<DeviceTicks> last_ticks_;
  std::optional<CaptureTime> last_stamp_;
  std::uint64_t resets_ = 0;
  std::uint64_t moved_ = 0;
};

}  // namespace isotherm
