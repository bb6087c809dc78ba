#include "ground/subscriber/rig_watch.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "common/base/log.h"

namespace isotherm {

RigSighting RigWatch::Look(SteadyTime now, const std::string& edge_id, bool has_status_writer,
                           const IsPresent& is_present) {
  roster_.Update(is_present);
  RigSighting sighting;
  sighting.sessions_to_refuse = LookAtRivals(now, edge_id);
  LogOverflow(now, edge_id);
  // A writer that is gone is known within its lease of a second, its participant within ten.
  sighting.present = has_status_writer && (is_present(gate_.owner()) || roster_.Has(edge_id));
  const std::string others_text =
      sighting.present || edge_id.empty() ? "" : OtherRigsText(edge_id, roster_.Others(edge_id));
  if (other_rigs_.Update(!others_text.empty(), now)) {
    LOG(Subscriber, Warning) << others_text;
  }
  sighting.problem = rivals_.empty()
                         ? others_text
                         : fmt::format("{} MORE of the name \"{}\", refused: give each rig a name",
                                       rivals_.size(), edge_id);
  return sighting;
}

std::string RigWatch::LookAtWays(SteadyTime now, const std::string& edge_id,
                                 std::map<PeerHandle, Announcement> announced,
                                 PeerHandle deaf_rig) {
  if (!edge_id.empty())
    std::erase_if(announced, [&](const auto& peer) { return peer.second.name != edge_id; });
  const std::optional<Announcement> silent =
      ways_.Look(now, announced, [this](PeerHandle peer) { return roster_.Knows(peer); });
  std::string problem;
  // A rig that has been switched off is not deaf.
  if (announced.contains(deaf_rig)) {
    problem =
        "THE RIG DOES NOT HEAR this computer: packets pass in one direction only (radio, a "
        "firewall)";
  } else if (silent) {
    problem = fmt::format(
        "the rig \"{}\" on \"{}\" announces itself, and nothing else of it arrives: packets pass "
        "in one direction only (radio, a firewall)",
        silent->name, silent->host);
  }
  if (problem == one_way_) return problem;
  one_way_ = problem;
  if (problem.empty()) {
    LOG(Subscriber, Info) << "packets to and from the rig pass again, or it has left";
  } else {
    LOG(Subscriber, Warning) << problem;
  }
  return problem;
}

std::vector<std::uint64_t> RigWatch::LookAtRivals(SteadyTime now, const std::string& edge_id) {
  const std::vector<RigGate::Rival> before = std::exchange(rivals_, gate_.rivals());
  LogRivals(before, edge_id);
  // Refusals are repeated, since a receipt may be lost.
  if (rivals_ == before && now < rivals_due_) return {};
  rivals_due_ = now + kRivalInterval;
  std::vector<std::uint64_t> sessions;
  for (const RigGate::Rival& rival : rivals_) {
    if (rival.session != 0) sessions.push_back(rival.session);
  }
  return sessions;
}

void RigWatch::LogRivals(const std::vector<RigGate::Rival>& before,
                         const std::string& edge_id) const {
  const auto has = [](const std::vector<RigGate::Rival>& rivals, PeerHandle peer) {
    return std::ranges::find(rivals, peer, &RigGate::Rival::peer) != rivals.end();
  };
  for (const RigGate::Rival& rival : rivals_) {
    if (has(before, rival.peer)) continue;
    LOG(Subscriber, Error) << fmt::format(
        "a second rig of the name \"{}\", on the computer \"{}\", is refused (its session {}): "
        "the scan of the first one, on \"{}\", goes on. Give one of them another name (--edge-id "
        "of isotherm-edge)",
        edge_id, roster_.HostOf(rival.peer), rival.session, roster_.HostOf(gate_.owner()));
  }
  for (const RigGate::Rival& rival : before) {
    if (has(rivals_, rival.peer)) continue;
    LOG(Subscriber, Info) << (rival.peer == gate_.owner()
                                  ? "the second rig of this name is followed now, session="
                                  : "a second rig of this name has left, session=")
                          << rival.session;
  }
}

void RigWatch::LogOverflow(SteadyTime now, const std::string& edge_id) {
  const std::uint64_t overflowed = gate_.overflowed();
  if (overflowed == told_overflow_ || !overflow_limiter_.Admit(now)) return;
  LOG(Subscriber, Warning) << fmt::format(
      "{} samples were refused: a rig \"{}\" that is not followed yet, or has not described "
      "itself, sent more than {} samples or {} MB",
      overflowed - std::exchange(told_overflow_, overflowed), edge_id, RigGate::kMaxHeldSamples,
      RigGate::kMaxHeldBytes >> 20U);
}

}  // namespace isotherm
