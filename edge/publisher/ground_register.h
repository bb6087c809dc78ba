#pragma once

#include <algorithm>
#include <cstdint>
#include <functional>
#include <vector>

#include "common/transport/endpoints.h"

namespace isotherm {

/// Knows who of the domain is a ground station, and which of them follow this rig. A ground station
/// has said so in its hello, in our wire version; another reader of the frames is an onlooker.
/// Pure. Thread-compatible.
class GroundRegister {
 public:
  /// Says which rig a ground follows, as its receipts tell.
  enum class Follows : std::uint8_t { kNotSaid, kThisRig, kAnotherRig };

  /// Holds one ground that is there.
  struct Ground {
    std::uint64_t hello_writer = 0;  ///< The ground is there while this writer is.
    PeerHandle peer = 0;
    Follows follows = Follows::kNotSaid;
  };

  void Add(std::uint64_t hello_writer, PeerHandle peer) {
    if (peer == 0) return;
    if (Ground* known = Find(peer)) {
      known->hello_writer = hello_writer;  // It was out of reach and is back.
    } else if (grounds_.size() < kMax) {
      grounds_.push_back({hello_writer, peer, Follows::kNotSaid});
    }
  }
  /// It has sent a receipt; if not `certain`, that counts only as long as nothing is known. False
  /// if `peer` is not a ground station.
  bool NoteReceipt(PeerHandle peer, bool for_this_rig, bool certain = true) {
    Ground* ground = Find(peer);
    if (ground == nullptr) return false;
    if (certain || ground->follows == Follows::kNotSaid) {
      ground->follows = for_this_rig ? Follows::kThisRig : Follows::kAnotherRig;
    }
    return true;
  }
  bool Knows(PeerHandle peer) const {
    return std::ranges::any_of(grounds_, [&](const Ground& g) { return g.peer == peer; });
  }
  void RemoveIf(const std::function<bool(const Ground&)>& is_gone) {
    std::erase_if(grounds_, is_gone);
  }

  bool empty() const { return grounds_.empty(); }
  /// Returns whether a ground says that it follows this rig, and reads its frames.
  bool HasFollower(const std::function<bool(PeerHandle)>& reads_frames) const {
    return std::ranges::any_of(grounds_, [&](const Ground& ground) {
      return ground.follows == Follows::kThisRig && reads_frames(ground.peer);
    });
  }
  /// Counts those, too, that have not said yet whom they follow: they are worth waiting for.
  bool MayHaveFollower(const std::function<bool(PeerHandle)>& reads_frames) const {
    return std::ranges::any_of(grounds_, [&](const Ground& ground) {
      return ground.follows != Follows::kAnotherRig && reads_frames(ground.peer);
    });
  }

 private:
  static constexpr std::size_t kMax = 64;  ///< Nobody has more; a flood of hellos ends here.

  Ground* Find(PeerHandle peer) {
    const auto found = std::ranges::find(grounds_, peer, &Ground::peer);
    return found == grounds_.end() ? nullptr : &*found;
  }

  std::vector<Ground> grounds_;
};

}  // namespace isotherm
