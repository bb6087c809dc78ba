#pragma once

#include <vector>

#include "common/base/status.h"

namespace isotherm {

class GroundOptions;
class LiveOptions;

Status Validate(const LiveOptions& options);

/// Checks every stage's options; returns all problems, not only the first.
std::vector<Status> ValidateAll(const GroundOptions& options);

}  // namespace isotherm
