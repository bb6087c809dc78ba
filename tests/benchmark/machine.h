#pragma once

#include <string>

namespace isotherm {

/// Returns what a measurement depends on, in one line: cores, load averages of the last 1, 5 and 15
/// minutes, and the SIMD instruction set that the kernels take.
std::string DescribeMachine();

/// Returns the memory of this process that is in use now, MiB.
double ResidentMib();

}  // namespace isotherm
