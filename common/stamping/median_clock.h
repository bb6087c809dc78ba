#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <vector>

#include "common/stamping/stamp.h"
#include "common/time/time_types.h"

namespace isotherm {

/// Median of the last N values, and how uncertain it is. Thread-compatible.
class SlidingMedian {
 public:
  explicit SlidingMedian(std::size_t window) : window_(window) {}

  void Add(Nanoseconds value);
  void Clear();

  std::size_t size() const { return sorted_.size(); }
  /// Mean of the two middle values if their count is even. Needs at least one value.
  Nanoseconds Median() const;
  /// Standard error of the median, from the spread (MAD): 1.25 x 1.48 x MAD / sqrt(n), at least the
  /// ticks' resolution; 0 with less than two values.
  Nanoseconds Sigma() const;

 private:
  const std::size_t window_;
  std::deque<Nanoseconds> values_;   ///< In order of arrival.
  std::vector<Nanoseconds> sorted_;  ///< The same, ascending.
};

/// Relates one camera's ticks to the edge's wall clock: the differences arrival - ticks go through
/// a median filter of length N, and the filtered difference is added back to the ticks (Ordonez
/// Müller, *Close range 3D thermography*, eq. 5.4).
///
///   warm-up  the first N - 1 frames use the median of the differences seen so far, the first one
///            its own
///   reset    ticks that go backwards are a new counter: the filter starts again from that frame
///
/// The sigma is random error only, without the constant transport delay and without drift. Pure: no
/// clock inside. Thread-compatible.
class MedianClock {
 public:
  /// `window` >= 1 frames.
  explicit MedianClock(int window);

  Stamp Process(DeviceTicks ticks, CaptureTime arrival);

  /// The camera was opened again: the next frame's ticks are of another counter.
  void BeginCounter();

  /// Counter resets seen.
  std::uint64_t resets() const { return resets_; }

 private:
  SlidingMedian differences_;
  std::optional<DeviceTicks> last_ticks_;
  std::uint64_t resets_ = 0;
};

}  // namespace isotherm
