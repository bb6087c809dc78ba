#include "ground/subscriber/clock_watch.h"

#include <fmt/format.h>

#include <cmath>

#include "common/base/log.h"

namespace isotherm {
namespace {

constexpr double kMsPerS = 1e3;

}  // namespace

void ClockWatch::Update(const EdgeStatus& status, const std::optional<ClockOffset>& offset,
                        const KernelClock& own, SteadyTime now) {
  const bool is_first = !seen_ || account_.session != status.session;
  if (is_first) {
    seen_ = true;
    // The difference and the alarm are about the clocks, not about the session.
    ClockAccount next;
    next.session = status.session;
    next.offset = account_.offset;
    next.alarm = account_.alarm;
    next.alarms = account_.alarm ? 1 : 0;
    account_ = next;
  }
  const ClockReport before = account_.rig;
  account_.rig = status.clock;
  account_.time = status.time;
  account_.unsynchronised = account_.unsynchronised || !status.clock.synchronised;
  account_.depth_camera = status.depth_camera;
  account_.thermal_camera = status.thermal_camera;
  Tell(before, is_first);
  Judge(offset);
  TellAlarm(own, now);
}

void ClockWatch::Judge(const std::optional<ClockOffset>& offset) {
  if (!offset) return;
  account_.offset = offset;
  const double certain_s = std::max(0.0, std::abs(offset->offset_s) - offset->uncertainty_s);
  account_.largest_offset_s = std::fmax(account_.largest_offset_s, certain_s);
  if (max_offset_ == Nanoseconds(0)) return;
  const double max_s = ToSeconds(max_offset_);
  if (!account_.alarm && certain_s > max_s) {
    account_.alarm = true;
    ++account_.alarms;
  } else if (std::abs(offset->offset_s) <= max_s) {
    account_.alarm = false;
  }
}

void ClockWatch::Tell(const ClockReport& before, bool is_first) {
  const ClockReport& rig = account_.rig;
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
        "capture "
        "time {:+.3f} s",
        rig.step_sum_s - before.step_sum_s, rig.step_sum_s);
  }
}

void ClockWatch::TellAlarm(const KernelClock& own, SteadyTime now) {
  if (!account_.alarm) {
    if (!told_) return;
    told_ = false;
    LOG(Subscriber, Info) << "the rig's clock agrees with ours again: "
                          << OffsetText(*account_.offset);
    return;
  }
  if (told_at_ && now - *told_at_ < kRepeat) return;
  told_ = true;
  told_at_ = now;
  LOG(Subscriber, Warning) << fmt::format(
      "CLOCK ALARM: the rig's clock is {}; {:.0f} ms are allowed (live.max_clock_offset_s). The "
      "rig says "
      "that it is {}; ours is {}. One of them follows a wrong time server, or none: look at "
      "chronyc "
      "sources on both (docs/timing.md)",
      OffsetText(*account_.offset), kMsPerS * ToSeconds(max_offset_), ToText(account_.rig),
      ToText(ToReport(own)));
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

std::string ClockText(const ClockAccount& account) {
  std::string text = account.alarm ? "CLOCK ALARM: " : "";
  text += ToText(account.rig);
  if (account.rig.synchronised && account.unsynchronised) text += " (not all the time)";
  text += ", ";
  text += account.offset ? OffsetText(*account.offset) : "not compared with ours yet";
  const std::string stamps = StampText(account.depth_camera, account.thermal_camera);
  return stamps.empty() ? text : text + "; stamps " + stamps;
}

}  // namespace isotherm
