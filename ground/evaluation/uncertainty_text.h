#pragma once

#include <string>

#include "ground/evaluation/uncertainty_evaluation.h"
#include "ground/json/json.h"

namespace isotherm {

/// Returns what `isotherm evaluate` prints of uncertainties: whether they are right, the histogram
/// of error / sigma, and the table of errors by distance and angle.
std::string ToText(const UncertaintyReport& report);
Json ToJson(const UncertaintyReport& report);

}  // namespace isotherm
