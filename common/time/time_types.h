#pragma once

#include <chrono>
#include <cstdint>

namespace isotherm {

/// The edge's wall clock (CLOCK_REALTIME as disciplined by chrony): nanoseconds since the Unix
/// epoch.
struct CaptureClock {
  using duration = std::chrono::nanoseconds;
  using rep = duration::rep;
  using period = duration::period;
  using time_point = std::chrono::time_point<CaptureClock>;
  static constexpr bool is_steady = false;
};

/// A camera's own counter: microseconds from an arbitrary zero, wrapping and resetting at its
/// pleasure.
struct DeviceClock {
  using duration = std::chrono::microseconds;
  using rep = duration::rep;
  using period = duration::period;
  using time_point = std::chrono::time_point<DeviceClock>;
  static constexpr bool is_steady = false;
};

/// The three times of a frame. They do not convert into each other: a Timestamper relates them.
using CaptureTime = CaptureClock::time_point;  ///< Middle of the exposure, edge wall clock.
using DeviceTicks = DeviceClock::time_point;   ///< Camera counter.
using SteadyTime = std::chrono::steady_clock::time_point;  ///< This computer's monotonic clock.

using Nanoseconds = std::chrono::nanoseconds;

constexpr CaptureTime CaptureTimeFromNanoseconds(std::int64_t ns) {
  return CaptureTime(Nanoseconds(ns));
}
constexpr std::int64_t ToNanoseconds(CaptureTime time) { return time.time_since_epoch().count(); }
constexpr double ToSeconds(Nanoseconds duration) {
  return std::chrono::duration<double>(duration).count();
}
/// Rounds to the nearest nanosecond.
constexpr Nanoseconds FromSeconds(double seconds) {
  return Nanoseconds(static_cast<std::int64_t>(seconds * 1e9 + (seconds < 0 ? -0.5 : 0.5)));
}

}  // namespace isotherm
