#include "ground/subscriber/rig_roster.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

namespace isotherm {

void RigRoster::Add(PeerHandle peer, const std::string& edge_id, const std::string& host) {
  if (peer == 0 || (rigs_.size() == kMaxRigs && !rigs_.contains(peer))) return;
  rigs_[peer] = {.edge_id = edge_id, .host = host};
}

void RigRoster::Update(const std::function<bool(PeerHandle)>& is_present) {
  std::erase_if(rigs_, [&](const auto& rig) { return !is_present(rig.first); });
}

bool RigRoster::Has(const std::string& edge_id) const {
  return std::ranges::any_of(rigs_, [&](const auto& rig) { return rig.second.edge_id == edge_id; });
}

std::vector<std::string> RigRoster::Others(const std::string& edge_id) const {
  std::set<std::string> names;
  for (const auto& [peer, rig] : rigs_)
    if (rig.edge_id != edge_id) names.insert(rig.edge_id);
  return {names.begin(), names.end()};
}

std::string RigRoster::HostOf(PeerHandle peer) const {
  const auto found = rigs_.find(peer);
  return found == rigs_.end() ? "" : found->second.host;
}

std::string OtherRigsText(const std::string& followed, const std::vector<std::string>& others) {
  if (others.empty()) return "";
  std::string names;
  for (const std::string& name : others) {
    names += fmt::format("{}\"{}\"", names.empty() ? "" : ", ", name);
  }
  return fmt::format("{} {} here, this ground follows \"{}\"; start with --edge-id {}",
                     others.size() == 1 ? "a rig" : "rigs",
                     names + (others.size() == 1 ? " is" : " are"), followed,
                     others.size() == 1 ? others.front() : "NAME");
}

bool OtherRigsNotice::Update(bool only_others, SteadyTime now) {
  if (only_others != only_others_) {
    only_others_ = only_others;
    since_ = now;
    reported_ = false;
  }
  if (!only_others || reported_ || now < since_ + kPatience) return false;
  reported_ = true;
  return true;
}

}  // namespace isotherm
