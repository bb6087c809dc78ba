#pragma once

#include <string>

namespace isotherm {

/// Says how long a recording may go on, in the operator's words and the same on both sides of the
/// link: "disk: 3 h left", "disk: 40 min left"; empty if that is not known (NaN).
std::string DiskTimeText(double left_s);

}  // namespace isotherm
