#include "ground/subscriber/clock_watch.h"

#include <fmt/format.h>

#include <cmath>

#include "common/base/log.h"
#include "common/base/units.h"

namespace isotherm {

void ClockWatch::Update(const EdgeStatus& status, const std::optional<ClockOffset>& offset,
                        const KernelClock& own, SteadyTime now) {
  const bool is_first = !seen_ || session_clock_.session != status.session;
  if (is_first) {
    seen_ = true;
    // The difference and the alarm are about the clocks, not about the session.
    SessionClock next;
    next.session = status.session;
    next.offset = session_clock_.offset;
    next.alarm = session_clock_.alarm;
    next.alarms = session_clock_.alarm ? 1 : 0;
    session_clock_ = next;
  }
  const ClockReport before = session_clock_.rig;
  session_clock_.rig = status.clock;
  session_clock_.time = status.time;
  session_clock_.unsynchronised = session_clock_.unsynchronised || !status.clock.synchronised;
  session_clock_.depth_camera = status.depth_camera;
  session_clock_.thermal_camera = status.thermal_camera;
  Log(before, is_first);
  Assess(offset);
  LogAlarm(own, now);
}

void ClockWatch::Assess(const std::optional<ClockOffset>& offset) {
  if (!offset) return;
  session_clock_.offset = offset;
  // The alarm begins when the clocks differ for certain, and ends when they may agree by the best
  // guess: a slow link, whose bounds are wide, raises none.
  const double certain_s = std::max(0.0, std::abs(offset->offset_s) - offset->uncertainty_s);
  session_clock_.largest_offset_s = std::fmax(session_clock_.largest_offset_s, certain_s);
  if (max_offset_ == Nanoseconds(0)) return;
  const double max_s = ToSeconds(max_offset_);
  if (!session_clock_.alarm && certain_s > max_s) {
    session_clock_.alarm = true;
    ++session_clock_.alarms;
  } else if (std::abs(offset->offset_s) <= max_s) {
    session_clock_.alarm = false;
  }
}

void ClockWatch::Log(const ClockReport& before, bool is_first) {
  const ClockReport& rig = session_clock_.rig;
  if (!rig.synchronised && (is_first || before.synchronised)) {
    LOG(Subscriber, Warning) << "the rig's clock is not synchronised: its capture times are right "
                                "among themselves, but not as UTC; see to chrony on the rig "
                                "(docs/timing.md)";
  }
  if (rig.synchronised && (is_first || !before.synchronised)) {
    LOG(Subscriber, Info) << "the rig's clock is " << ToText(rig);
  }
  if (rig.steps != before.steps) {
    LOG(Subscriber, Warning) << fmt::format(
        "the rig's clock was set by {:+.3f} s; capture times do not follow: from here on UTC = "
        "capture time {:+.3f} s",
        rig.step_sum_s - before.step_sum_s, rig.step_sum_s);
  }
}

void ClockWatch::LogAlarm(const KernelClock& own, SteadyTime now) {
  if (!session_clock_.alarm) {
    if (!reported_) return;
    reported_ = false;
    LOG(Subscriber, Info) << "the rig's clock agrees with ours again: "
                          << OffsetText(*session_clock_.offset);
    return;
  }
  if (reported_at_ && now - *reported_at_ < kRepeat) return;
  reported_ = true;
  reported_at_ = now;
  LOG(Subscriber, Warning) << fmt::format(
      "CLOCK ALARM: the rig's clock is {}; {:.0f} ms are allowed (live.expert.max_clock_offset_s). "
      "The rig says that it is {}; ours is {}. One of them follows a wrong time server, or none: "
      "look at chronyc sources on both (docs/timing.md)",
      OffsetText(*session_clock_.offset), kMsPerS * ToSeconds(max_offset_),
      ToText(session_clock_.rig), ToText(ToReport(own)));
}

std::string OffsetText(const ClockOffset& offset) {
  const double size_s = std::abs(offset.offset_s);
  const char* side = offset.offset_s < 0.0 ? "behind" : "ahead of";
  if (size_s < 1.0) {
    return fmt::format("{:.1f} ms {} ours (+-{:.1f} ms)", kMsPerS * size_s, side,
                       kMsPerS * offset.uncertainty_s);
  }
  return fmt::format("{:.3f} s {} ours (+-{:.3f} s)", size_s, side, offset.uncertainty_s);
}

std::string ClockText(const SessionClock& clock) {
  std::string text = clock.alarm ? "CLOCK ALARM: " : "";
  text += ToText(clock.rig);
  if (clock.rig.synchronised && clock.unsynchronised) text += " (not all the time)";
  text += ", ";
  text += clock.offset ? OffsetText(*clock.offset) : "not compared with ours yet";
  const std::string stamps = StampText(clock.depth_camera, clock.thermal_camera);
  return stamps.empty() ? text : text + "; stamps " + stamps;
}

}  // namespace isotherm
