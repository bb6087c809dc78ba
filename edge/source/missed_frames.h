#pragma once

#include <cstdint>
#include <optional>

namespace isotherm {

/// Tells how many frames a camera counted and did not deliver, by the counter that comes with each
/// frame. The same rule for all cameras:
///
/// - A counter that goes on by at most kMaxMissed frames tells how many are missing. More cannot
///   be lost without a stall, which is found out by the clock.
/// - Any other step is in doubt, and nothing is missing before that frame. If the next counter goes
///   on from where it was before, one value was damaged; if it goes on from the new one, the
///   counter was set anew.
///
/// Thread-compatible.
class MissedFrames {
 public:
  /// Half a minute at 30 Hz: the sources' stall limits are seconds.
  static constexpr std::uint64_t kMaxMissed = 1000;

  /// `step`: how much the counter grows from frame to frame, nominally; at least 1.
  explicit MissedFrames(std::uint64_t step) : step_(step) {}

  /// Returns what is missing before the frame with this counter.
  std::uint64_t Process(std::uint64_t counter) {
    const std::optional<std::uint64_t> since_trusted = FramesSince(trusted_, counter);
    if (!trusted_ || since_trusted) {
      const std::uint64_t missed = since_trusted ? MissedOf(*since_trusted, in_doubt_ ? 1 : 0) : 0;
      Restart(counter);
      return missed;
    }
    if (const std::optional<std::uint64_t> since_doubtful = FramesSince(in_doubt_, counter)) {
      Restart(counter);
      return MissedOf(*since_doubtful, 0);
    }
    in_doubt_ = counter;
    return 0;
  }

  /// Goes on from here, whatever was before.
  void Restart(std::uint64_t counter) {
    trusted_ = counter;
    in_doubt_.reset();
  }

 private:
  /// Nullopt: this cannot be what comes after `before`.
  std::optional<std::uint64_t> FramesSince(std::optional<std::uint64_t> before,
                                           std::uint64_t counter) const {
    if (!before || counter <= *before) return std::nullopt;
    // The step is the nominal one: now and then it is one less or more.
    const std::uint64_t grown = counter - *before;
    const std::uint64_t frames = grown / step_ + (grown % step_ > step_ / 2 ? 1 : 0);
    if (frames > kMaxMissed + 1) return std::nullopt;
    return frames;
  }
  static std::uint64_t MissedOf(std::uint64_t frames, std::uint64_t delivered_between) {
    return frames > delivered_between + 1 ? frames - delivered_between - 1 : 0;
  }

  const std::uint64_t step_;
  std::optional<std::uint64_t> trusted_;
  std::optional<std::uint64_t> in_doubt_;  ///< Counter of the frame before, if it did not go on.
};

}  // namespace isotherm
