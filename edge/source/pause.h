#pragma once

#include <stop_token>

#include "common/time/time_types.h"

namespace isotherm {

/// Sleeps for `duration`, or until stop is requested.
void Pause(const std::stop_token& stop, Nanoseconds duration);

}  // namespace isotherm
