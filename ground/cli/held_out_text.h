#pragma once

#include <string>

#include "ground/json/json.h"
#include "ground/offline/held_out_report.h"

namespace isotherm {

/// Returns what `isotherm evaluate --held-out-views` prints.
std::string ToText(const HeldOutReport& report);
Json ToJson(const HeldOutReport& report);

}  // namespace isotherm
