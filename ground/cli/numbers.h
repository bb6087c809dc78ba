#pragma once

#include <string_view>
#include <vector>

#include "common/base/status.h"

namespace isotherm {

/// Finite numbers separated by spaces or commas; as many as one of `counts` says. `option` names it
/// in messages.
Result<std::vector<double>> ParseNumbers(std::string_view text,
                                         std::initializer_list<std::size_t> counts,
                                         std::string_view option);

}  // namespace isotherm
