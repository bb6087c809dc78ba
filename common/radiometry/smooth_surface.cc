#include "common/radiometry/smooth_surface.h"

#include <fmt/format.h>

#include <cmath>

namespace isotherm {

Status Validate(const SmoothSurface& surface) {
  if (!(surface.normal_emissivity > 0.0 && surface.normal_emissivity <= 1.0)) {
    return InvalidArgument(
        fmt::format("emissivity must be above 0 and at most 1, got {}", surface.normal_emissivity));
  }
  if (!(surface.refractive_index >= 1.0)) {
    return InvalidArgument(
        fmt::format("refractive index must be at least 1, got {}", surface.refractive_index));
  }
  if (!(surface.extinction_coefficient >= 0.0 && std::isfinite(surface.extinction_coefficient))) {
    return InvalidArgument(fmt::format("extinction coefficient must be 0 or more, got {}",
                                       surface.extinction_coefficient));
  }
  if (!(surface.reflected_celsius >= kMinRadiometric_celsius &&
        surface.reflected_celsius <= kMaxRadiometric_celsius)) {
    return InvalidArgument(fmt::format("ambient temperature must be {}..{} degrees Celsius, got {}",
                                       kMinRadiometric_celsius, kMaxRadiometric_celsius,
                                       surface.reflected_celsius));
  }
  return OkStatus();
}

double ApparentAtAngle(const BandRadiance& band, const SmoothSurface& surface,
                       double apparent_celsius, double from_rad, double to_rad) {
  const auto emissivity = [&](double angle_rad) {
    return DirectionalEmissivity(angle_rad, surface.normal_emissivity, surface.refractive_index,
                                 surface.extinction_coefficient);
  };
  // By (3.1), what is sent beyond the reflected radiance is proportional to the emissivity.
  const double reflected = band.RadianceFromCelsius(surface.reflected_celsius);
  const double beyond = band.RadianceFromCelsius(apparent_celsius) - reflected;
  return band.CelsiusFromRadiance(reflected + emissivity(to_rad) / emissivity(from_rad) * beyond);
}

}  // namespace isotherm
