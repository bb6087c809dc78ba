#pragma once

#include <optional>

#include "common/messages/messages.h"
#include "common/time/time_types.h"
#include "common/transport/endpoints.h"

namespace isotherm {

/// Notices that the rig serves another ground station than this one (EdgeStatus::served_ground).
/// Pure: time enters through arguments. Thread-compatible.
class ServedWatch {
 public:
  /// A ground that takes another one's place is served after two seconds, and told of it by the
  /// next status.
  static constexpr Nanoseconds kPatience = std::chrono::seconds(4);

  /// `self` is how the rig knows this ground.
  void OnStatus(const EdgeStatus& status, PeerHandle self, SteadyTime now) {
    const bool is_other = status.served_ground != 0 && status.served_ground != self;
    if (!is_other) since_.reset();
    if (is_other && !since_) since_ = now;
    other_ = since_ && now - *since_ >= kPatience ? status.served_ground : 0;
  }
  /// Returns the ground that is served instead of this one; 0: none.
  PeerHandle other() const { return other_; }

 private:
  std::optional<SteadyTime> since_;
  PeerHandle other_ = 0;
};

}  // namespace isotherm
