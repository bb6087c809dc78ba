#pragma once

#include "common/base/status.h"
#include "ground/options/ground_options.pb.h"

namespace isotherm {

Status Validate(const ConsoleOptions& options);

}  // namespace isotherm
