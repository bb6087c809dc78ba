#include "ground/subscriber/clock_comparison.h"

#include <algorithm>
#include <cmath>

namespace isotherm {

std::uint64_t ClockComparison::Ping(SteadyTime now) {
  if (pinged_.size() == kMaxPings) pinged_.pop_front();
  pinged_.push_back(now);
  return next_ping_++;
}

std::optional<SteadyTime> ClockComparison::SentAt(std::uint64_t ping) const {
  if (ping >= next_ping_ || next_ping_ - ping > pinged_.size()) return std::nullopt;
  return pinged_[pinged_.size() - static_cast<std::size_t>(next_ping_ - ping)];
}

void ClockComparison::Add(const ClockEcho& echo, SteadyTime now) {
  const std::optional<SteadyTime> pinged = SentAt(echo.ping);
  if (!pinged) return;
  const Sample sample{.pinged = *pinged,
                      .time = now,
                      // The rig received the ping after it was sent and sent the echo before it
                      // arrived: the two bounds hold however long the ways took.
                      .lower = echo.sent.time_since_epoch() - now.time_since_epoch(),
                      .upper = echo.received.time_since_epoch() - pinged->time_since_epoch()};
  // Impossible, unless the rig's clock was set between ping and echo: what was known is over, too.
  if (sample.upper < sample.lower || echo.sent < echo.received) return samples_.clear();
  std::erase_if(samples_, [&](const Sample& older) {
    return now - older.time > kWindow || Contradict(older, sample);
  });
  samples_.push_back(sample);
}

double ClockComparison::Uncertainty(const Sample& sample, SteadyTime now) {
  return 0.5 * ToSeconds(sample.upper - sample.lower) + kMaxDrift * ToSeconds(now - sample.pinged);
}

bool ClockComparison::Contradict(const Sample& older, const Sample& newer) {
  const Nanoseconds drift = FromSeconds(kMaxDrift * ToSeconds(newer.time - older.pinged));
  return older.upper + drift < newer.lower || newer.upper < older.lower - drift;
}

std::optional<ClockOffset> ClockComparison::Offset(const ClockReading& now) const {
  const auto best = std::ranges::min_element(
      samples_, {}, [&](const Sample& sample) { return Uncertainty(sample, now.steady); });
  if (best == samples_.end() || now.steady - best->time > kWindow) return std::nullopt;
  const Nanoseconds rig = best->lower + (best->upper - best->lower) / 2;
  const Nanoseconds own = now.wall.time_since_epoch() - now.steady.time_since_epoch();
  return ClockOffset{.offset_s = ToSeconds(rig - own),
                     .uncertainty_s = Uncertainty(*best, now.steady)};
}

}  // namespace isotherm
