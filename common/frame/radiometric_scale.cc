#include "common/frame/radiometric_scale.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace isotherm {
namespace {

/// Steps that are coarser hide what such cameras resolve.
constexpr double kMaxStep_k = 1.0;
/// Larger offsets are typing errors: no camera's scale begins beyond the hottest thing there is.
constexpr double kMaxOffset_k = 10'000.0;
/// A scale that reaches none of these is a typing error.
constexpr double kColdest_celsius = -100.0;
constexpr double kHottest_celsius = 1500.0;
/// ScaleForRange takes the finest that reaches: 0.01 K to 382 °C with an offset of 0, as most
/// cameras have it, then steps that still lie below the noise of such cameras (0.04 K).
constexpr double kSteps_k[] = {0.01, 0.02, 0.03, 0.05};

}  // namespace

std::uint16_t RadiometricScale::CountOf(double celsius) const {
  const double count = std::round((celsius + kCelsiusZero_k - offset_kelvin) / kelvin_per_count);
  return count >= 1.0 && count <= kMaxCount ? static_cast<std::uint16_t>(count) : std::uint16_t{0};
}

std::uint16_t RadiometricScale::NearestCountOf(double celsius) const {
  if (std::isnan(celsius)) return 0;
  const double count = std::round((celsius + kCelsiusZero_k - offset_kelvin) / kelvin_per_count);
  return static_cast<std::uint16_t>(std::clamp(count, 1.0, kMaxCount));
}

Status Validate(const RadiometricScale& scale) {
  if (!(scale.kelvin_per_count > 0.0 && scale.kelvin_per_count <= kMaxStep_k)) {
    return InvalidArgument(
        fmt::format("thermal_scale (kelvin per unit of the thermal images) must be above 0 and at "
                    "most {} K, got {}",
                    kMaxStep_k, scale.kelvin_per_count));
  }
  if (!(std::abs(scale.offset_kelvin) <= kMaxOffset_k)) {
    return InvalidArgument(
        fmt::format("thermal_offset (kelvin of a unit of 0) must be within +-{} K, got {}",
                    kMaxOffset_k, scale.offset_kelvin));
  }
  if (scale.max_celsius() < kColdest_celsius || scale.min_celsius() > kHottest_celsius) {
    return InvalidArgument(fmt::format(
        "thermal_scale {} K and thermal_offset {} K: 16 bits reach from {:.1f} to {:.1f} °C, where "
        "no thermal camera measures ({} to {} °C)",
        scale.kelvin_per_count, scale.offset_kelvin, scale.min_celsius(), scale.max_celsius(),
        kColdest_celsius, kHottest_celsius));
  }
  return OkStatus();
}

Result<RadiometricScale> ScaleForRange(double min_celsius, double max_celsius) {
  for (const double step_k : kSteps_k) {
    const RadiometricScale scale{step_k, 0.0};
    if (min_celsius >= scale.min_celsius() && max_celsius <= scale.max_celsius() &&
        min_celsius < max_celsius) {
      return scale;
    }
  }
  return Err(InvalidArgument(
      fmt::format("temperatures from {} to {} °C fit into no scale of 16 bits in use (from {:.1f} "
                  "to {:.0f} °C)",
                  min_celsius, max_celsius, RadiometricScale{kSteps_k[0], 0.0}.min_celsius(),
                  RadiometricScale{kSteps_k[3], 0.0}.max_celsius())));
}

}  // namespace isotherm
