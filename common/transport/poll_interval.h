#pragma once

#include "common/time/time_types.h"

namespace isotherm {

/// What the middleware does not signal is looked at this often while somebody waits for it.
inline constexpr Nanoseconds kPollInterval = std::chrono::milliseconds(20);

}  // namespace isotherm
