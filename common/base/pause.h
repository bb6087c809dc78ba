#pragma once

#include <chrono>
#include <stop_token>

namespace isotherm {

/// Sleeps for `duration`, or until stop is requested.
void Pause(const std::stop_token& stop, std::chrono::nanoseconds duration);

}  // namespace isotherm
