#pragma once

#include "common/base/status.h"

namespace isotherm {

class EdgeOptions;

/// Checks ranges and relations of all stages. The message lists every problem, one per line, as
/// "stage.field: what is wrong".
Status Validate(const EdgeOptions& options);

}  // namespace isotherm
