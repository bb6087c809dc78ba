#pragma once

#include <functional>
#include <string>

#include "common/base/status.h"
#include "common/messages/messages.h"
#include "common/transport/participant.h"
#include "ground/subscriber/rig_commander.h"

namespace CLI {
class App;
}

namespace isotherm {

/// Says which running rig is meant, and how long it may take to answer.
struct RigAddress {
  std::string edge_id;
  int domain = 0;
  double timeout_s = 5.0;
};

void AddRigAddress(CLI::App& command, RigAddress& address);

/// Finds the rig and does `work` with it and its newest status. Errors are those of
/// RigCommander::AwaitStatus and of `work`.
Status WithRig(const RigAddress& address,
               const std::function<Status(RigCommander& rig, const EdgeStatus& status)>& work);

/// The same for work that speaks with the rig by itself.
Status WithLink(
    const RigAddress& address,
    const std::function<Status(const Participant& link, const std::string& edge_id)>& work);

/// Sends the order and prints the rig's answer. kUnavailable if it refuses or fails, with its
/// reason.
Status SendOrder(RigCommander& rig, const Command& order, const RigAddress& address);

}  // namespace isotherm
