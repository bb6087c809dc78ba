#pragma once

#include <cstddef>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "common/time/time_types.h"
#include "common/transport/endpoints.h"

namespace isotherm {

/// Knows which rigs are there, by their hellos. Bounded. Thread-compatible.
class RigRoster {
 public:
  /// Further rigs are not named: whoever floods the domain must not fill memory.
  static constexpr std::size_t kMaxRigs = 32;

  void Add(PeerHandle peer, const std::string& edge_id, const std::string& host);
  /// Forgets who has left.
  void Update(const std::function<bool(PeerHandle)>& is_present);

  bool Has(const std::string& edge_id) const;
  bool Knows(PeerHandle peer) const { return rigs_.contains(peer); }
  /// Names of the others, each once.
  std::vector<std::string> Others(const std::string& edge_id) const;
  /// Computer of a rig's process; empty = not known.
  std::string HostOf(PeerHandle peer) const;

 private:
  /// Names a rig that is there.
  struct Rig {
    std::string edge_id;
    std::string host;
  };
  std::map<PeerHandle, Rig> rigs_;
};

/// Returns what to do when the followed rig is not there but others are: one sentence. Empty if
/// there are none.
std::string OtherRigsText(const std::string& followed, const std::vector<std::string>& others);

/// Decides when that is said: once each time it becomes so, and not while the rigs are still
/// appearing. Thread-compatible.
class OtherRigsNotice {
 public:
  /// Twice the middleware's lease (qos.h), within which rigs that are there have been discovered.
  /// Not tuned.
  static constexpr Nanoseconds kPatience = std::chrono::seconds(2);

  /// True once when the rig has been missing, and another one there, for kPatience.
  bool Update(bool only_others, SteadyTime now);

 private:
  bool reported_ = false;
  SteadyTime since_{};
  bool only_others_ = false;
};

}  // namespace isotherm
