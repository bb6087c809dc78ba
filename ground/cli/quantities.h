#pragma once

#include <string_view>

#include "common/base/status.h"
#include "ground/limits/angle_limits.h"

namespace isotherm {

/// "10mm", "0.5 m", "25um": metres. The unit (m, cm, mm, um, µm) must be there; the value must be
/// finite and positive. `option` names it in messages.
Result<double> ParseLength(std::string_view text, std::string_view option);

/// "2%" (ratio of radiance) or "1.5K".
Result<ErrorTolerance> ParseTolerance(std::string_view text, std::string_view option);

}  // namespace isotherm
