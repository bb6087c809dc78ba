#pragma once

#include <cstdint>
#include <optional>

#include "common/time/time_types.h"
#include "common/transport/refusal.h"

namespace isotherm {

/// Holds what a frame says of its place in the stream, and when it came.
struct FrameMark {
  std::uint64_t number = 0;
  CaptureTime time{};
  SteadyTime arrival{};  ///< Ground.
};

/// A camera that delivers gives a frame at least this often.
inline constexpr Nanoseconds kMaxFramePeriod = std::chrono::seconds(1);
/// Frames of a camera per second, more than any has.
inline constexpr double kMaxFrameRate_hz = 200.0;
/// Numbers that may be missing whatever the times say.
inline constexpr std::uint64_t kFreeNumbers = 64;
/// A frame may arrive this much sooner than the frame before.
inline constexpr Nanoseconds kMaxJitter = std::chrono::milliseconds(250);

/// Says why `frame` cannot be in one stream with `before`, nullopt if it can: capture times rise
/// with the numbers; they advance no more than the ground's clock did, or than the frames between
/// explain (a replay is faster, a burst after an outage too); numbers advance no faster than
/// cameras do. The wall clocks of both sides need not agree.
std::optional<RefusalCause> CheckFollows(const FrameMark& before, const FrameMark& frame);

/// Returns whether `frame` can follow a gap in a recording that is played as fast as the ground
/// takes it: the ground's clock did not see the gap. A frame is recorded before it is played, so it
/// cannot be later than `now`, the ground's wall clock.
bool MayFollowGap(const FrameMark& before, const FrameMark& frame, CaptureTime now);

}  // namespace isotherm
