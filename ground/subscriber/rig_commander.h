#pragma once

#include <functional>
#include <map>
#include <memory>
#include <string>
#include <utility>

#include "common/base/status.h"
#include "common/messages/messages.h"
#include "common/time/clock.h"
#include "common/transport/endpoints.h"
#include "common/transport/participant.h"
#include "common/transport/wait_set.h"

namespace isotherm {

/// Gives a rig single orders and waits for its answers, beside the ground station that receives its
/// frames or without one. Thread-bound.
class RigCommander {
 public:
  /// `edge_id`: which rig; empty: the only one. `participant` and `clock` must outlive it.
  static Result<std::unique_ptr<RigCommander>> Create(const Participant& participant,
                                                      const Clock& clock, std::string edge_id);

  /// The rig's next status. kUnavailable after `timeout`: the message names the rigs that are there
  /// and what to check. kInvalidArgument if it is not clear which rig is meant.
  Result<EdgeStatus> AwaitStatus(Nanoseconds timeout);
  /// Sends the order (its number and time are set here) to the rig that AwaitStatus has found and
  /// waits for the answer. kUnavailable after `timeout`.
  Result<CommandResult> Send(Command command, Nanoseconds timeout);
  /// Name of the rig; empty before a status has come.
  const std::string& edge_id() const { return edge_id_; }

 private:
  /// Holds what a rig has told of itself.
  struct KnownRig {
    EdgeStatus status;
    PeerHandle peer = 0;
  };

  RigCommander(const Clock& clock, std::string edge_id)
      : clock_(clock), edge_id_(std::move(edge_id)) {}
  Status Open(const Participant& participant);
  void TakeStatuses();
  /// Says which rigs are there, or what to check if none is.
  std::string KnownNames() const;
  bool WaitUntil(Nanoseconds timeout, const std::function<bool()>& done);

  const Clock& clock_;
  std::string edge_id_;
  PeerHandle peer_ = 0;  ///< The process of the rig that was found.
  std::map<std::string, KnownRig> rigs_;
  RefusalCounter refusals_;
  Reader<EdgeStatus> statuses_;
  Reader<CommandResult> results_;
  Writer<Command> commands_;
  WaitSet wait_set_;
};

}  // namespace isotherm
