#include "ground/subscriber/rig_commander.h"

#include <fmt/format.h>

#include <optional>
#include <utility>

namespace isotherm {
namespace {

using namespace std::chrono_literals;

constexpr Nanoseconds kPollInterval = 20ms;  // For what the middleware does not signal.

}  // namespace

Result<std::unique_ptr<RigCommander>> RigCommander::Create(const Participant& participant,
                                                           const Clock& clock,
                                                           std::string edge_id) {
  if (edge_id.size() > kMaxIdBytes)
    return Err(InvalidArgument(fmt::format("edge_id must have at most {} bytes", kMaxIdBytes)));
  std::unique_ptr<RigCommander> commander(new RigCommander(clock, std::move(edge_id)));
  if (const Status opened = commander->Open(participant); !opened.ok()) return Err(opened);
  return commander;
}

Status RigCommander::Open(const Participant& participant) {
  ISOTHERM_RETURN_IF_ERROR(statuses_.Open(participant, &refusals_));
  ISOTHERM_RETURN_IF_ERROR(results_.Open(participant, &refusals_));
  ISOTHERM_RETURN_IF_ERROR(commands_.Open(participant));
  ISOTHERM_RETURN_IF_ERROR(wait_set_.Open(participant));
  ISOTHERM_RETURN_IF_ERROR(wait_set_.Attach(statuses_));
  return wait_set_.Attach(results_);
}

Result<EdgeStatus> RigCommander::AwaitStatus(Nanoseconds timeout) {
  std::optional<EdgeStatus> found;
  // What is kept of a scan that has ended is not the state now.
  const auto take = [&](Received<EdgeStatus>&& received) {
    if (!edge_id_.empty() && received.edge_id != edge_id_) return;
    EdgeStatus& status = received.message;
    if (status.scan_state == ScanState::kEnded) return;
    edge_id_ = received.edge_id;
    found = std::move(status);
  };
  const bool came = WaitUntil(timeout, [&] {
    statuses_.Take(take);
    return found.has_value();
  });
  if (came) return *found;
  return Err(Unavailable(fmt::format(
      "no status from {} within {:.1f} s: is isotherm-edge running, in the same domain and "
      "with the same CYCLONEDDS_URI?",
      edge_id_.empty() ? "any rig" : fmt::format("rig \"{}\"", edge_id_), ToSeconds(timeout))));
}

Result<CommandResult> RigCommander::Send(Command command, Nanoseconds timeout) {
  if (!WaitUntil(timeout, [&] { return commands_.matched_readers() > 0; }))
    return Err(Unavailable(fmt::format(
        "rig \"{}\" takes no commands: is it still running, and of this version?", edge_id_)));
  command.time = clock_.Now();
  // Unlike those of a ground station that has been running for longer.
  command.number = static_cast<std::uint64_t>(ToNanoseconds(command.time));
  if (const Status sent = commands_.Write(edge_id_, command); !sent.ok()) return Err(sent);
  std::optional<CommandResult> answer;
  const auto take = [&](Received<CommandResult>&& received) {
    if (received.edge_id == edge_id_ && received.message.number == command.number)
      answer = std::move(received.message);
  };
  const bool came = WaitUntil(timeout, [&] {
    results_.Take(take);
    return answer.has_value();
  });
  if (came) return *answer;
  return Err(Unavailable(
      fmt::format("rig \"{}\" did not answer within {:.1f} s; it may follow the order yet: "
                  "`isotherm nuc` shows the state",
                  edge_id_, ToSeconds(timeout))));
}

bool RigCommander::WaitUntil(Nanoseconds timeout, const std::function<bool()>& done) {
  const SteadyTime deadline = clock_.SteadyNow() + timeout;
  while (!done()) {
    if (clock_.SteadyNow() >= deadline) return false;
    wait_set_.Wait(kPollInterval);
  }
  return true;
}

}  // namespace isotherm
