#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "common/messages/messages.h"
#include "common/time/kernel_clock.h"
#include "common/time/time_types.h"
#include "ground/subscriber/session_counters.h"

namespace isotherm {

/// Watches the rig's wall clock for the operator: says when it loses or finds synchronisation, when
/// it is set, and raises an alarm when it differs from ours by more than is allowed. The alarm is
/// raised only for a difference beyond what a slow link may pretend, and ends when the best
/// estimate is within what is allowed. It is told at most once in `kRepeat`. Thread-compatible.
class ClockWatch {
 public:
  /// `max_offset` 0 = no alarm.
  explicit ClockWatch(Nanoseconds max_offset) : max_offset_(max_offset) {}

  /// A status of the rig has come; `own` is this computer's clock, for the message only.
  void Update(const EdgeStatus& status, const std::optional<ClockOffset>& offset,
              const KernelClock& own, SteadyTime now);
  /// The clock in the session of the newest status.
  const SessionClock& clock() const { return session_clock_; }

  /// While the clock stays wrong, the alarm is repeated, but must not fill the log.
  static constexpr Nanoseconds kRepeat = std::chrono::minutes(1);

 private:
  void Assess(const std::optional<ClockOffset>& offset);
  void Log(const ClockReport& before, bool is_first);
  void LogAlarm(const KernelClock& own, SteadyTime now);

  Nanoseconds max_offset_;
  bool seen_ = false;  ///< A status has come.
  SessionClock session_clock_;
  std::optional<SteadyTime> reported_at_;  ///< When the alarm was last logged.
  bool reported_ = false;                  ///< The log says that the alarm is on.
};

/// "0.3 ms ahead of ours (+-0.4 ms)", "80.1 ms behind ours (+-0.4 ms)".
std::string OffsetText(const ClockOffset& offset);
/// One line: synchronisation, steps, difference to ours, alarm, stamps.
std::string ClockText(const SessionClock& clock);

}  // namespace isotherm
