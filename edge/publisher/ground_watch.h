#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <utility>

#include "common/messages/messages.h"
#include "common/time/time_types.h"
#include "common/transport/endpoints.h"
#include "edge/publisher/ground_register.h"
#include "edge/publisher/ground_relation.h"

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
  /// Returns whether a ground that follows this rig reads what `reads` says.
  bool HasFollower(const Reads& reads) const { return grounds_.HasFollower(reads); }
  /// Returns whether that holds for a ground that follows this rig, or may. An onlooker is not
  /// waited for, and nobody is while our session is refused: it will never be confirmed.
  bool IsAwaited(const Reads& reads, SteadyTime now) const {
    return !relation_.IsRefused(now) && grounds_.MayHaveFollower(reads);
  }
  bool IsRefused(SteadyTime now) const { return relation_.IsRefused(now); }
  bool is_present() const { return is_present_; }
  /// As GroundRelation::Problem().
  std::string Problem(SteadyTime now) const { return relation_.Problem(now); }

 private:
  void LogRelation(SteadyTime now);

  const std::string edge_id_;
  GroundRegister grounds_;
  GroundRelation relation_;
  bool is_present_ = false;
};

}  // namespace isotherm
