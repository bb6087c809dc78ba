#pragma once

#include <string>

namespace isotherm {

/// The IPv4 addresses of this computer's network interfaces, with the interfaces they are of; not
/// its local one. Another text means that peers may not reach this computer any more where they
/// knew it; an interface that is down and has kept its address changes nothing. Others do not
/// count: the profiles use IPv4, and those of IPv6 come and go. Empty if it has none.
std::string NetworkAddresses();

}  // namespace isotherm
