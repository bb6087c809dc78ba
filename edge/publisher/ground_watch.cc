#include "edge/publisher/ground_watch.h"

#include <fmt/format.h>

#include <utility>

#include "common/base/log.h"

namespace isotherm {

bool GroundWatch::OnReceipt(PeerHandle sender, const std::string& edge_id, const Receipt& receipt,
                            const std::optional<std::uint64_t>& session, SteadyTime now) {
  const bool ours = edge_id == edge_id_;
  const bool accepted = receipt.verdict == SessionVerdict::kFollowed;
  // What it says of another session of this name takes nothing back of what it said of ours.
  const bool certain = !ours || !session || receipt.session == 0 || receipt.session == session;
  if (!grounds_.NoteReceipt(sender, ours && accepted, certain)) return false;
  relation_.OnReceipt(edge_id, receipt, session.value_or(0), now);
  return true;
}

bool GroundWatch::Look(SteadyTime now,
                       const std::function<bool(std::uint64_t hello_writer)>& is_there) {
  bool left = false;
  grounds_.RemoveIf([&](const GroundRegister::Ground& ground) {
    const bool is_gone = !is_there(ground.hello_writer);
    if (is_gone) served_.OnLeft(ground.peer);
    left = left || is_gone;
    return is_gone;
  });
  LogRelation(now);
  LogOther(now);
  const bool present = !grounds_.empty();
  if (present == is_present_) return left;
  is_present_ = present;
  LOG(Publisher, Info) << (present ? "ground station found" : "ground station lost");
  return left;
}

void GroundWatch::LookAtWays(SteadyTime now, const std::map<PeerHandle, Announcement>& announced,
                             PeerHandle unheard_by) {
  const std::optional<Announcement> silent =
      ways_.Look(now, announced, [this](PeerHandle peer) { return Knows(peer); });
  std::string problem;
  // What it got when it was still there says nothing of a ground that has left.
  if (announced.contains(unheard_by)) {
    problem =
        "is heard, and nothing that this rig sends arrives there: packets pass in one "
        "direction only (radio, a firewall)";
  } else if (silent) {
    problem = fmt::format(
        "on \"{}\" announces itself, and nothing else of it arrives: packets pass in one direction "
        "only (radio, a firewall)",
        silent->host);
  }
  if (problem == one_way_) return;
  one_way_ = problem;
  if (problem.empty()) {
    LOG(Publisher, Info) << "packets to and from the ground station pass again, or it has left";
  } else {
    LOG(Publisher, Warning) << "the ground station " << problem;
  }
}

void GroundWatch::LogOther(SteadyTime now) {
  const PeerHandle other = served_.other(now);
  if (std::exchange(told_other_, other) == other || other == 0) return;
  LOG(Publisher, Warning) << "another ground station follows this rig, too: it gets what is sent, "
                             "nothing is sent again for its sake, and its advice is not shown";
}

void GroundWatch::LogRelation(SteadyTime now) {
  const std::optional<std::string> news = relation_.News(now);
  if (!news) return;
  if (news->empty()) {
    LOG(Publisher, Info) << "the ground station follows this rig now, or has left";
  } else if (relation_.IsRefused(now)) {
    LOG(Publisher, Error) << "the ground station " << *news;
  } else {
    LOG(Publisher, Warning) << "a ground station " << *news;
  }
}

}  // namespace isotherm
