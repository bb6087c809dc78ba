#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "common/messages/messages.h"

namespace isotherm {

/// Says what a process of this system is, to all of the domain: the middleware repeats it all the
/// time, so that it is heard also by who cannot be heard.
struct Announcement {
  Role role = Role::kEdge;
  std::string name;  ///< The edge_id of a rig; empty for a ground station.
  std::string host;
  friend bool operator==(const Announcement&, const Announcement&) = default;
};

/// "isotherm-edge drone-2@raspi".
std::string ToText(const Announcement& announcement);
/// nullopt for anything else. What a peer says may be shown as it is.
std::optional<Announcement> ParseAnnouncement(std::string_view text);

}  // namespace isotherm
