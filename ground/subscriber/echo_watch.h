#pragma once

#include <cstdint>
#include <optional>

#include "common/messages/messages.h"
#include "common/time/time_types.h"
#include "common/transport/endpoints.h"

namespace isotherm {

/// Notices that the rig is heard and does not hear the ground: its statuses come, once a second,
/// and echo no new ping of those that receipts carry, five a second. Another ground's pings hide
/// that. Pure: time enters through arguments. Thread-compatible.
class EchoWatch {
 public:
  /// Three statuses without a new echo. Not tuned.
  static constexpr Nanoseconds kPatience = std::chrono::milliseconds(3500);

  void OnStatus(PeerHandle rig, const EdgeStatus& status, SteadyTime now) {
    const std::uint64_t ping = status.clock_echo ? status.clock_echo->ping : 0;
    const bool is_new = ping != 0 && ping != ping_;
    // In a pause of the statuses nothing was heard in either direction.
    const bool was_pause = !heard_at_ || now - *heard_at_ > kPause;
    if (is_new || was_pause) silent_since_ = now;
    if (is_new) is_deaf_ = false;
    if (now - silent_since_ >= kPatience) is_deaf_ = true;
    rig_ = rig;
    ping_ = ping;
    heard_at_ = now;
  }
  /// Returns the rig that hears nothing; 0 = none. When its statuses stop, too, what was last known
  /// stands: a rig that hears nobody falls silent.
  PeerHandle deaf_rig() const { return is_deaf_ ? rig_ : 0; }

 private:
  static constexpr Nanoseconds kPause = std::chrono::seconds(2);

  PeerHandle rig_ = 0;
  std::uint64_t ping_ = 0;  ///< The newest echo; 0 = none.
  std::optional<SteadyTime> heard_at_;
  SteadyTime silent_since_{};  ///< The newest echo that was new, or the first status.
  bool is_deaf_ = false;
};

}  // namespace isotherm
