#pragma once

#include <cstdint>
#include <optional>

#include "common/time/clock.h"
#include "common/time/time_types.h"

namespace isotherm {

/// Both clocks of the computer at one moment.
struct ClockReading {
  CaptureTime wall;
  SteadyTime steady;
};

/// Reads both as nearly at once as a few tries allow.
ClockReading ReadClocks(const Clock& clock);

/// Time line of one scan that steps of the wall clock do not touch: the wall clock at the start,
/// carried on by the monotonic clock. Both are slewed alike by time synchronisation, so that their
/// difference changes only when somebody sets the wall clock, or at a leap second; then the wall
/// clock is ahead of the time line by the sum of all steps from there on. Pure. Thread-compatible.
class StepWatch {
 public:
  explicit StepWatch(const ClockReading& start) : start_(start) {}

  /// The moment on the time line.
  CaptureTime At(SteadyTime steady) const { return start_.wall + (steady - start_.steady); }

  /// A step, once it is certain: kConfirmations readings in a row agree that the wall clock is off
  /// by more than kMinStep. One that was interrupted between both clocks does not count.
  std::optional<Nanoseconds> Observe(const ClockReading& reading);

  std::uint64_t steps() const { return steps_; }
  /// Wall clock minus time line: what to add to a capture time to get the wall clock's.
  Nanoseconds total() const { return total_; }

  /// chrony slews offsets of this size and does not step them. Smaller: an interrupted reading
  /// looks like a step; larger: a step moves stamps unnoticed by this much.
  static constexpr Nanoseconds kMinStep = std::chrono::milliseconds(1);
  /// Readings in a row, a frame apart: one that was interrupted between the clocks does not repeat
  /// itself. Not tuned.
  static constexpr int kConfirmations = 3;

 private:
  const ClockReading start_;
  Nanoseconds total_{0};
  Nanoseconds suspected_{0};  ///< Beyond total_.
  int agreeing_ = 0;
  std::uint64_t steps_ = 0;
};

}  // namespace isotherm
