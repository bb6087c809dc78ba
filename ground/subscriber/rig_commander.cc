#include "ground/subscriber/rig_commander.h"

#include <fmt/format.h>

#include <optional>
#include <utility>

#include "common/transport/poll_interval.h"

namespace isotherm {
namespace {

using namespace std::chrono_literals;

// Rigs on one network answer a newcomer within some milliseconds of each other.
constexpr Nanoseconds kOthersToo = 300ms;

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
  rigs_.clear();
  const bool any = edge_id_.empty();
  const bool came = WaitUntil(timeout, [&] {
    TakeStatuses();
    return any ? !rigs_.empty() : rigs_.contains(edge_id_);
  });
  if (!came) {
    const std::string who = any ? "any rig" : fmt::format("rig \"{}\"", edge_id_);
    return Err(Unavailable(fmt::format("no status from {} within {:.1f} s; {}", who,
                                       ToSeconds(timeout), KnownNames())));
  }
  // The rigs keep their last status for whoever comes later: all have told by then.
  const auto never = [&] {
    TakeStatuses();
    return false;
  };
  if (any) WaitUntil(kOthersToo, never);
  if (any && rigs_.size() > 1) {
    return Err(InvalidArgument("several rigs are there, say which one is meant; " + KnownNames()));
  }
  const auto& [name, rig] = any ? *rigs_.begin() : *rigs_.find(edge_id_);
  edge_id_ = name;
  peer_ = rig.peer;
  return rig.status;
}

void RigCommander::TakeStatuses() {
  statuses_.Take([this](Received<EdgeStatus>&& received) {
    const PeerHandle peer = statuses_.PeerOf(received.writer);
    if (peer == 0) return;  // It has left.
    rigs_[received.edge_id] = {std::move(received.message), peer};
  });
}

std::string RigCommander::KnownNames() const {
  if (rigs_.empty()) {
    return "is isotherm-edge running, in the same domain and with the same CYCLONEDDS_URI?";
  }
  std::string names;
  for (const auto& [name, rig] : rigs_) {
    names += fmt::format("{}\"{}\"", names.empty() ? "" : ", ", name);
  }
  return fmt::format("rigs that are there (--edge-id): {}", names);
}

Result<CommandResult> RigCommander::Send(Command command, Nanoseconds timeout) {
  // Other rigs read commands as well: theirs is not the reader to wait for.
  if (!WaitUntil(timeout, [&] { return commands_.Reaches(peer_); })) {
    return Err(Unavailable(fmt::format(
        "rig \"{}\" takes no commands: is it still running, and of this version?", edge_id_)));
  }
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
                  "`isotherm scan` and `isotherm nuc` show the state",
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
