#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>

#include "common/messages/messages.h"
#include "common/time/time_types.h"

namespace isotherm {

/// Decides whether another frame may go out before the ground has handled the ones under way
/// (lossless policy). What counts is frames that were published, not frame numbers: numbers that
/// were left out before publishing are never handled, and to wait for them would be for ever. Pure.
/// Thread-compatible.
class FlowWindow {
 public:
  FlowWindow(std::size_t window_frames, Nanoseconds timeout)
      : window_frames_(window_frames), timeout_(timeout) {}

  /// Nothing of the new session is under way yet.
  void BeginSession() {
    under_way_.clear();
    progress_.reset();
    given_up_ = false;
  }
  /// Numbers must rise.
  void OnPublished(std::uint64_t frame_number) {
    under_way_.push_back(frame_number);
    // Without receipts the newest are enough to know that the window is full.
    if (under_way_.size() > window_frames_) under_way_.pop_front();
  }
  /// The ground has handled all frames below `handled`.
  void OnReceipt(std::uint64_t handled, SteadyTime now) {
    given_up_ = false;  // It is alive.
    while (!under_way_.empty() && under_way_.front() < handled) {
      under_way_.pop_front();
      progress_ = now;
    }
  }

  bool HasRoom() const { return given_up_ || under_way_.size() < window_frames_; }
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
  const std::size_t window_frames_;
  const Nanoseconds timeout_;
  std::deque<std::uint64_t> under_way_;  ///< Published and not yet handled.
  std::optional<SteadyTime> progress_;   ///< When frames were last handled, or when waiting began.
  bool given_up_ = false;
};

}  // namespace isotherm
