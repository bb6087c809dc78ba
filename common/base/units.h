#pragma once

#include <cstdint>
#include <numbers>

namespace isotherm {

// Between the units that people read and write and those that are computed with (m, s, rad, kelvin,
// bytes).

inline constexpr double kRadPerDeg = std::numbers::pi / 180.0;
inline constexpr double kFullCircle_rad = 2.0 * std::numbers::pi;
inline constexpr double kMmPerM = 1e3;
inline constexpr double kMPerMm = 1e-3;
inline constexpr double kMPerUm = 1e-6;
inline constexpr double kMsPerS = 1e3;
inline constexpr double kSPerMs = 1e-3;
inline constexpr double kSPerMin = 60.0;
inline constexpr double kSPerHour = 3600.0;
inline constexpr std::int64_t kNanosecondsPerSecond = 1'000'000'000;
inline constexpr double kBytesPerMb = 1e6;
inline constexpr double kCelsiusZero_k = 273.15;

}  // namespace isotherm
