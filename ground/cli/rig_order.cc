#include "ground/cli/rig_order.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>

#include "common/transport/participant.h"
#include "common/transport/transport_environment.h"

namespace isotherm {

void AddRigAddress(CLI::App& command, RigAddress& address) {
  command.add_option("--edge-id", address.edge_id, "Which rig, if there are several")
      ->type_name("NAME");
  command.add_option("--domain", address.domain, "DDS domain, 0..230")
      ->check(CLI::Range(0, kMaxDomainId))
      ->type_name("N");
  command.add_option("--timeout", address.timeout_s, "How long to wait for the rig, seconds")
      ->check(CLI::Range(0.1, 600.0))
      ->capture_default_str();
}

namespace {

/// Holds what `work` needs of the link and of the rig that was found on it.
struct FoundRig {
  const Participant& link;
  RigCommander& rig;
  const EdgeStatus& status;
};

Status WithFoundRig(const RigAddress& address, const std::function<Status(const FoundRig&)>& work) {
  const SystemClock clock{};
  const TransportEnvironment environment(clock);
  const auto participant = Participant::Create(environment, address.domain);
  if (!participant) return participant.error();
  const auto rig = RigCommander::Create(**participant, clock, address.edge_id);
  if (!rig) return rig.error();
  const Result<EdgeStatus> status = (*rig)->AwaitStatus(FromSeconds(address.timeout_s));
  return status ? work({**participant, **rig, *status}) : status.error();
}

}  // namespace

Status WithRig(const RigAddress& address,
               const std::function<Status(RigCommander& rig, const EdgeStatus& status)>& work) {
  return WithFoundRig(address,
                      [&work](const FoundRig& found) { return work(found.rig, found.status); });
}

Status WithLink(
    const RigAddress& address,
    const std::function<Status(const Participant& link, const std::string& edge_id)>& work) {
  return WithFoundRig(
      address, [&work](const FoundRig& found) { return work(found.link, found.rig.edge_id()); });
}

Status SendOrder(RigCommander& rig, const Command& order, const RigAddress& address) {
  const Result<CommandResult> answer = rig.Send(order, FromSeconds(address.timeout_s));
  if (!answer) return answer.error();
  // Scripts tell a refusal by the exit status (69).
  if (answer->outcome != CommandOutcome::kDone) {
    const bool refused = answer->outcome == CommandOutcome::kRefused;
    return Unavailable(
        fmt::format("{} {}: {}", rig.edge_id(), refused ? "refuses" : "failed", answer->text));
  }
  fmt::print("{}: {}\n", rig.edge_id(), answer->text.empty() ? "done" : answer->text);
  return OkStatus();
}

}  // namespace isotherm
