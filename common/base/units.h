#pragma once

#include <cstdint>
#include <numbers>

namespace isotherm {

// Between the units that people read and write and those that are computed with (rad, s, bytes).

inline constexpr double kRadPerDeg = std::numbers::pi / 180.0;
inline constexpr double kMsPerS = 1e3;
inline constexpr std::int64_t kNanosecondsPerSecond = 1'000'000'000;
inline constexpr double kBytesPerMb = 1e6;

}  // namespace isotherm
