#include "ground/subscriber/frame_succession.h"

#include <algorithm>

namespace isotherm {

std::optional<RefusalCause> CheckFollows(const FrameMark& before, const FrameMark& frame) {
  // Neither is negative (CheckFrame), so that the difference fits.
  const Nanoseconds advance = frame.time - before.time;
  if (frame.number < before.number) {
    if (advance > Nanoseconds(0)) return RefusalCause::kImplausibleTime;
    return std::nullopt;
  }
  const std::uint64_t numbers = frame.number - before.number;
  const auto explained = static_cast<std::int64_t>(std::min(numbers, kFreeNumbers));
  const Nanoseconds waited = frame.arrival - before.arrival;
  if (advance < Nanoseconds(0) ||
      advance > std::max(waited, explained * kMaxFramePeriod) + kMaxJitter) {
    return RefusalCause::kImplausibleTime;
  }
  const double possible = kMaxFrameRate_hz * ToSeconds(advance);
  if (static_cast<double>(numbers) > static_cast<double>(kFreeNumbers) + possible) {
    return RefusalCause::kImpossibleNumber;
  }
  return std::nullopt;
}

bool MayFollowGap(const FrameMark& before, const FrameMark& frame, CaptureTime now) {
  if (frame.number <= before.number || frame.time <= before.time || frame.time > now) return false;
  FrameMark waited_for = frame;
  waited_for.arrival = before.arrival + (frame.time - before.time);
  return !CheckFollows(before, waited_for);
}

}  // namespace isotherm
