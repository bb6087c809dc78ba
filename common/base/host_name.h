#pragma once

#include <string>

namespace isotherm {

/// Returns this computer's name; empty if it cannot be found out.
std::string HostName();

}  // namespace isotherm
