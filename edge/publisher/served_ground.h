#pragma once

#include <algorithm>
#include <cstddef>
#include <optional>
#include <vector>

#include "common/time/time_types.h"
#include "common/transport/endpoints.h"

namespace isotherm {

/// Decides whose receipts count where several ground stations follow this rig: those of the one
/// whose receipt came first, as long as it is heard. Frames are published once, so the others get
/// them too, but nothing is sent again for their sake. After an outage it is the first one's turn
/// again. Pure: time enters through arguments. Thread-compatible.
class ServedGround {
 public:
  /// The next one has its turn when the ones before have been silent for so long: receipts come
  /// five times a second. Longer: the successor of a ground that was killed waits longer.
  static constexpr Nanoseconds kSilence = std::chrono::seconds(2);
  /// Another one is told of when it has been heard for so long: the successor of one that was
  /// killed is no other.
  static constexpr Nanoseconds kPatience = std::chrono::seconds(4);

  /// A ground has sent a receipt of our session that can be true. Returns whether it counts.
  bool OnReceipt(PeerHandle ground, SteadyTime now) {
    Ground& sender = FindOrAdd(ground);
    if (!IsHeard(sender, now)) sender.heard_since = now;
    sender.heard = now;
    const auto first =
        std::ranges::find_if(grounds_, [&](const Ground& one) { return IsHeard(one, now); });
    served_ = first->peer;
    return served_ == ground;
  }
  /// It has left, and is not waited for. Its place is kept: an outage looks like that, too.
  void OnLeft(PeerHandle ground) {
    for (Ground& known : grounds_)
      if (known.peer == ground) known.heard.reset();
  }
  /// Returns the one whose receipts count; 0: none was heard.
  PeerHandle served() const { return served_; }
  /// Returns another one that is heard as well; 0: there is none.
  PeerHandle other(SteadyTime now) const {
    for (const Ground& ground : grounds_) {
      const bool is_other = ground.peer != served_ && IsHeard(ground, now);
      if (is_other && now - ground.heard_since >= kPatience) return ground.peer;
    }
    return 0;
  }

 private:
  static constexpr std::size_t kMax = 8;  ///< Nobody has more.

  /// Holds a ground that follows this rig, and when it was heard.
  struct Ground {
    PeerHandle peer = 0;
    SteadyTime heard_since{};
    std::optional<SteadyTime> heard{};  ///< nullopt: it has left.
  };

  static bool IsHeard(const Ground& ground, SteadyTime now) {
    return ground.heard && now - *ground.heard < kSilence;
  }
  Ground& FindOrAdd(PeerHandle peer) {
    const auto known = std::ranges::find(grounds_, peer, &Ground::peer);
    if (known != grounds_.end()) return *known;
    if (grounds_.size() == kMax)
      grounds_.erase(std::ranges::min_element(grounds_, {}, &Ground::heard));
    grounds_.push_back({.peer = peer});
    return grounds_.back();
  }

  std::vector<Ground> grounds_;  ///< In the order in which they came.
  PeerHandle served_ = 0;
};

}  // namespace isotherm
