#pragma once

#include <cstdint>
#include <optional>

#include "common/time/time_types.h"
#include "common/transport/messages.h"

namespace isotherm {

/// Decides whether another frame may go out before the ground has handled the ones under way
/// (lossless policy). Pure. Thread-compatible.
class FlowWindow {
 public:
  FlowWindow(std::uint64_t window_frames, Nanoseconds timeout)
      : window_frames_(window_frames), timeout_(timeout) {}

  /// Nothing of the new session is handled yet.
  void BeginSession() {
    handled_ = 0;
    progress_.reset();
    given_up_ = false;
  }
  /// The ground has handled all frames below `handled`.
  void OnReceipt(std::uint64_t handled, SteadyTime now) {
    given_up_ = false;  // It is alive.
    if (handled <= handled_) return;
    handled_ = handled;
    progress_ = now;
  }

  bool HasRoom(std::uint64_t frame_number) const {
    return given_up_ || frame_number < handled_ + window_frames_;
  }
  /// To be asked while there is no room: true once when the ground made no progress for the
  /// timeout. From then on there is room until the next receipt, so that a ground that hangs costs
  /// the timeout once and not per frame.
  bool GiveUp(SteadyTime now) {
    if (!progress_) progress_ = now;
    if (given_up_ || now - *progress_ < timeout_) return false;
    given_up_ = true;
    progress_.reset();
    return true;
  }

 private:
  const std::uint64_t window_frames_;
  const Nanoseconds timeout_;
  std::uint64_t handled_ = 0;
  std::optional<SteadyTime> progress_;  ///< When handled_ last grew, or when waiting began.
  bool given_up_ = false;
};

}  // namespace isotherm
