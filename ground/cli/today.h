#pragma once

#include <string>

namespace isotherm {

/// The day, by the computer's clock, in UTC: "2025-03-31".
std::string Today();

}  // namespace isotherm
