#pragma once

#include <cstddef>
#include <functional>
#include <map>
#include <optional>

#include "common/time/time_types.h"
#include "common/transport/announcement.h"
#include "common/transport/endpoints.h"

namespace isotherm {

/// Notices peers that announce themselves, and of which nothing else is heard: packets pass in one
/// direction only. Pure: time enters through arguments. Thread-compatible.
class OneWayWatch {
 public:
  /// Two that have just found each other need a moment, on a poor link more. Not tuned.
  static constexpr Nanoseconds kPatience = std::chrono::seconds(5);
  /// One that was heard and was killed is still announced for the middleware's lease of ten
  /// seconds. Not tuned beyond that.
  static constexpr Nanoseconds kPatienceAfterwards = std::chrono::seconds(15);
  /// Whoever floods the domain with participants must not fill memory.
  static constexpr std::size_t kMaxPeers = 1024;

  /// Something of a peer was heard, and it is not known further: it speaks another version, say.
  void OnHeard(PeerHandle peer) {
    if (peers_.size() < kMaxPeers || peers_.contains(peer)) peers_[peer].is_stranger = true;
  }
  /// To be called several times a second with those that are announced. `is_heard` says whether
  /// anything else of one is heard. Returns one of which it is not.
  std::optional<Announcement> Look(SteadyTime now,
                                   const std::map<PeerHandle, Announcement>& announced,
                                   const std::function<bool(PeerHandle)>& is_heard) {
    if (peers_.size() >= kMaxPeers) peers_.clear();
    for (auto& [peer, state] : peers_)
      state.is_announced = state.is_announced && announced.contains(peer);
    std::optional<Announcement> silent;
    for (const auto& [peer, announcement] : announced) {
      State& state = peers_[peer];
      if (!state.is_announced) state.silent_since = now;  // Found, or found again.
      state.is_announced = true;
      if (state.is_stranger || is_heard(peer)) {
        state.silent_since = now;
        state.patience = kPatienceAfterwards;
      } else if (now - state.silent_since >= state.patience) {
        silent = announcement;
      }
    }
    return silent;
  }

 private:
  struct State {
    SteadyTime silent_since{};
    Nanoseconds patience = kPatience;
    bool is_announced = false;
    bool is_stranger = false;
  };
  std::map<PeerHandle, State> peers_;  ///< All there ever were.
};

}  // namespace isotherm
