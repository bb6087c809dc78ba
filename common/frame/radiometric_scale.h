#pragma once

#include <cstdint>

#include "common/base/status.h"
#include "common/base/units.h"

namespace isotherm {

/// Says what the pixels of thermal images mean, as apparent temperature: kelvin = kelvin_per_count
/// x count + offset_kelvin. Count 0 is "no value", whatever the scale. Nothing else turns counts
/// into temperatures or back. The default is centi-kelvin, which ends at 382 °C.
struct RadiometricScale {
  double kelvin_per_count = 0.01;
  double offset_kelvin = 0.0;

  constexpr double Kelvin(double count) const { return kelvin_per_count * count + offset_kelvin; }
  constexpr float Celsius(double count) const {
    return static_cast<float>(Kelvin(count) - kCelsiusZero_k);
  }
  /// Returns the nearest count; 0 (no value) for what the scale does not reach, and for NaN.
  std::uint16_t CountOf(double celsius) const;
  /// Does the same, but returns the first or the last count for what lies beyond; 0 for NaN.
  std::uint16_t NearestCountOf(double celsius) const;

  /// The temperatures of the first and the last count.
  constexpr double min_celsius() const { return Kelvin(1.0) - kCelsiusZero_k; }
  constexpr double max_celsius() const { return Kelvin(kMaxCount) - kCelsiusZero_k; }

  friend bool operator==(const RadiometricScale&, const RadiometricScale&) = default;

  static constexpr double kMaxCount = 65535.0;
};

/// Every recording, rig file and program understands this one, also from before there were others.
inline constexpr RadiometricScale kCentikelvin{};

/// Refuses what no thermal camera has. The message names the fields of the rig file, thermal_scale
/// and thermal_offset.
Status Validate(const RadiometricScale& scale);

/// Returns the finest of the scales in use that reaches from one temperature to the other:
/// centi-kelvin up to 382 °C, 0.02 K up to 1037 °C, 0.03 K up to 1692 °C, 0.05 K up to 3003 °C.
/// kInvalidArgument if none does.
Result<RadiometricScale> ScaleForRange(double min_celsius, double max_celsius);

}  // namespace isotherm
