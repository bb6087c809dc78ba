#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "common/time/line_limiter.h"
#include "common/time/time_types.h"
#include "common/transport/announcement.h"
#include "common/transport/endpoints.h"
#include "common/transport/one_way_watch.h"
#include "ground/subscriber/rig_gate.h"
#include "ground/subscriber/rig_roster.h"

namespace isotherm {

/// Holds what a look at the rigs of the link found.
struct RigSighting {
  bool present = false;  ///< The rig that is followed is there.
  /// Tells the operator what is wrong with the rigs that are there. Empty = nothing.
  std::string problem;
  /// Sessions of rivals that are to be told now that they are refused.
  std::vector<std::uint64_t> sessions_to_refuse;
};

/// Watches which rigs are there, which is the one that is followed, and which only says so, and
/// logs when that changes. Pure but for the log: time enters through arguments. Thread-compatible.
class RigWatch {
 public:
  using IsPresent = std::function<bool(PeerHandle)>;

  /// A rival is told this often that it is refused.
  static constexpr Nanoseconds kRivalInterval = std::chrono::seconds(1);

  /// `gate` decides who is the rig, and must outlive the watch.
  explicit RigWatch(const RigGate& gate) : gate_(gate) {}

  /// The process `peer` has said that it is an edge.
  void Add(PeerHandle peer, const std::string& edge_id, const std::string& host) {
    roster_.Add(peer, edge_id, host);
  }
  /// To be called several times in a second, after the gate's Update(). `edge_id` is the name of
  /// the rig that is followed, `has_status_writer` whether anybody writes statuses.
  RigSighting Look(SteadyTime now, const std::string& edge_id, bool has_status_writer,
                   const IsPresent& is_present);
  /// Tells what is heard of the rig `edge_id` (empty: any) and by it, after Look: `announced` are
  /// those that announce themselves, `deaf_rig` is one that hears nothing of this ground. Returns
  /// what the operator is told; empty: packets pass in both directions, or in none.
  std::string LookAtWays(SteadyTime now, const std::string& edge_id,
                         std::map<PeerHandle, Announcement> announced, PeerHandle deaf_rig);
  /// A process has said that it is an edge of another version.
  void AddStranger(PeerHandle peer) { ways_.OnHeard(peer); }

 private:
  std::vector<std::uint64_t> LookAtRivals(SteadyTime now, const std::string& edge_id);
  void LogRivals(const std::vector<RigGate::Rival>& before, const std::string& edge_id) const;
  void LogOverflow(SteadyTime now, const std::string& edge_id);

  const RigGate& gate_;
  RigRoster roster_;
  OtherRigsNotice other_rigs_;
  OneWayWatch ways_;
  std::string one_way_;  ///< As told last.
  std::vector<RigGate::Rival> rivals_;
  SteadyTime rivals_due_{};
  std::uint64_t told_overflow_ = 0;
  LineLimiter overflow_limiter_;
};

}  // namespace isotherm
