#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>

#include "common/messages/messages.h"
#include "common/time/step_watch.h"
#include "common/time/time_types.h"

namespace isotherm {

/// Tells how the rig's wall clock compares with ours.
struct ClockOffset {
  double offset_s = 0.0;       ///< Rig minus ground.
  double uncertainty_s = 0.0;  ///< The true difference is no farther from it than this.
};

/// Compares the rig's wall clock with ours by what goes back and forth anyway: a receipt carries a
/// ping, a status echoes it, as NTP does it (Mills et al., RFC 5905, sections 8 and 10).
///
///   ground   ping ---------.                       .---> status
///                           \                     /
///   rig                      '-> received   sent -'
///
/// A message takes time, but never less than none: what the rig's clock showed when the ping came
/// is too late for the moment it was sent, and what it showed when the status left is too early for
/// the moment it came. So the difference is bounded from both sides, however unequal the ways there
/// and back are; half the round trip is the uncertainty. Of the last `kWindow` the round trip that
/// took least counts. Bounds that contradict older ones say that a clock was set: the older ones
/// are forgotten.
///
/// Our own wall clock may be set meanwhile: moments here are remembered by the monotonic clock.
/// Pure: no clock inside. Thread-compatible.
class ClockComparison {
 public:
  /// Two ground stations must not take each other's echoes for their own: `first_ping`, above 0,
  /// should be a number that the other does not come near.
  explicit ClockComparison(std::uint64_t first_ping) : next_ping_(first_ping) {}

  /// Returns what to put into a receipt that is sent now.
  std::uint64_t Ping(SteadyTime now);
  /// An echo has come. Echoes of pings that are not ours, or long ago, are ignored.
  void Add(const ClockEcho& echo, SteadyTime now);
  /// nullopt before the first echo, and when none has come for `kWindow`.
  std::optional<ClockOffset> Offset(const ClockReading& now) const;

  /// Echoes come with the edge's status, once a second. The quickest of eight waited least, and in
  /// that time the clocks drift apart by 1.6 ms at most. Larger: a clock that was set shows later;
  /// smaller: the quickest answer is slower. Not tuned.
  static constexpr Nanoseconds kWindow = std::chrono::seconds(8);
  /// Two free-running quartz clocks drift by 100 ppm each.
  static constexpr double kMaxDrift = 200e-6;

 private:
  /// Bounds of the rig's wall clock minus our monotonic clock.
  struct Sample {
    SteadyTime pinged;
    SteadyTime time;
    Nanoseconds lower;
    Nanoseconds upper;
  };
  std::optional<SteadyTime> SentAt(std::uint64_t ping) const;
  /// Half the round trip and what both clocks may have drifted since.
  static double Uncertainty(const Sample& sample, SteadyTime now);
  static bool Contradict(const Sample& older, const Sample& newer);

  static constexpr std::size_t kMaxPings = 512;  ///< Ten seconds at forty receipts a second.
  std::uint64_t next_ping_;
  std::deque<SteadyTime> pinged_;  ///< The newest last.
  std::deque<Sample> samples_;
};

}  // namespace isotherm
