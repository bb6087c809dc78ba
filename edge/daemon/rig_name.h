#pragma once

#include <string>
#include <string_view>

namespace isotherm {

/// The name of a rig on the link, made of its computer's host name: without the domain, with "-"
/// for what the link does not allow in a name, at most 32 bytes; "edge" if nothing is left.
std::string RigNameOf(std::string_view host_name);

/// The name of this computer as the name of its rig.
std::string HostRigName();

}  // namespace isotherm
