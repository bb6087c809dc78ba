#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <utility>

#include "common/messages/messages.h"
#include "common/time/time_types.h"
#include "common/transport/announcement.h"
#include "common/transport/endpoints.h"
#include "common/transport/one_way_watch.h"
#include "edge/publisher/ground_register.h"
#include "edge/publisher/ground_relation.h"
#include "edge/publisher/served_ground.h"

namespace isotherm {

/// Watches which ground stations are there and what they make of this rig, and logs when that
/// changes. Pure but for the log: time enters through arguments. Thread-compatible.
class GroundWatch {
 public:
  using Reads = std::function<bool(PeerHandle)>;

  explicit GroundWatch(std::string edge_id) : edge_id_(std::move(edge_id)), relation_(edge_id_) {}

  /// The process `peer` has said that it is a ground station.
  void Add(std::uint64_t hello_writer, PeerHandle peer) { grounds_.Add(hello_writer, peer); }
  /// `sender` has sent `receipt` to the rig `edge_id`. Returns whether it is a ground station.
  bool OnReceipt(PeerHandle sender, const std::string& edge_id, const Receipt& receipt,
                 const std::optional<std::uint64_t>& session, SteadyTime now);
  /// Forgets the grounds whose writer of hellos is gone, and logs what is new. Returns whether one
  /// has left.
  bool Look(SteadyTime now, const std::function<bool(std::uint64_t hello_writer)>& is_there);

  bool Knows(PeerHandle peer) const { return grounds_.Knows(peer); }
  /// Enters that a ground has sent a receipt of our session that can be true. Returns whether it
  /// counts.
  bool AdmitReceipt(PeerHandle peer, SteadyTime now) { return served_.OnReceipt(peer, now); }
  /// Returns whether what this ground says of what it has counts, and what it advises. Before any
  /// said so, all do.
  bool IsServed(PeerHandle peer) const {
    return Knows(peer) && (served_.served() == 0 || served_.served() == peer);
  }
  PeerHandle served() const { return served_.served(); }
  /// Returns whether a ground that follows this rig reads what `reads` says.
  bool HasFollower(const Reads& reads) const { return grounds_.HasFollower(reads); }
  /// Returns whether that holds for a ground that follows this rig, or may. An onlooker is not
  /// waited for, and nobody is while our session is refused: it will never be confirmed.
  bool IsAwaited(const Reads& reads, SteadyTime now) const {
    return !relation_.IsRefused(now) && grounds_.MayHaveFollower(reads);
  }
  bool IsRefused(SteadyTime now) const { return relation_.IsRefused(now); }
  /// Tells what is heard of grounds and by them, several times a second: `announced` are those that
  /// announce themselves, `unheard_by` is the one at which nothing arrives that this rig sends.
  void LookAtWays(SteadyTime now, const std::map<PeerHandle, Announcement>& announced,
                  PeerHandle unheard_by);
  /// A process has said that it is a ground station of another version.
  void AddStranger(PeerHandle peer) { ways_.OnHeard(peer); }
  bool is_present() const { return is_present_; }
  /// As GroundRelation::Problem(), or says that packets pass in one direction only.
  std::string Problem(SteadyTime now) const {
    const std::string problem = relation_.Problem(now);
    return problem.empty() ? one_way_ : problem;
  }

 private:
  void LogRelation(SteadyTime now);
  void LogOther(SteadyTime now);

  const std::string edge_id_;
  GroundRegister grounds_;
  GroundRelation relation_;
  ServedGround served_;
  PeerHandle told_other_ = 0;  ///< Another ground that follows this rig, as logged last.
  OneWayWatch ways_;
  std::string one_way_;  ///< Empty: packets pass in both directions, or in none.
  bool is_present_ = false;
};

}  // namespace isotherm
