#pragma once

#include <vector>

#include "common/base/status.h"

namespace isotherm {

class EdgeOptions;
class LinkOptions;
class DisplayOptions;

Status Validate(const LinkOptions& options);
Status Validate(const DisplayOptions& options);

/// Checks every stage's options; returns all problems, not only the first. A message has a line per
/// problem: "stage.field: what is wrong".
std::vector<Status> ValidateAll(const EdgeOptions& options);

}  // namespace isotherm
