#pragma once

#include "common/time/time_types.h"

namespace isotherm {

/// Interval between two looks at what the middleware does not signal, while somebody waits for it.
/// Larger: answers come later; smaller: more wake-ups for nothing. Not tuned.
inline constexpr Nanoseconds kPollInterval = std::chrono::milliseconds(20);

}  // namespace isotherm
