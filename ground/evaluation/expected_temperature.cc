#include "ground/evaluation/expected_temperature.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "common/base/units.h"

namespace isotherm {

ExpectedTemperature ExpectTemperature(const BandRadiance& band, const SmoothSurface& surface,
                                      double true_celsius, double angle_deg, double sigma_deg) {
  const auto at = [&](double degrees) {
    const double emissivity =
        DirectionalEmissivity(kRadPerDeg * degrees, surface.normal_emissivity,
                              surface.refractive_index, surface.extinction_coefficient);
    return ApparentCelsius(band, true_celsius, emissivity, surface.reflected_celsius);
  };
  if (std::isnan(angle_deg)) {
    return {
        ApparentCelsius(band, true_celsius, surface.normal_emissivity, surface.reflected_celsius),
        0.0};
  }
  // The slope is taken over a degree: about the uncertainty of the angle that it is multiplied
  // with.
  constexpr double kStep_deg = 0.5;
  const double per_degree =
      (at(angle_deg + kStep_deg) - at(std::max(0.0, angle_deg - kStep_deg))) / (2.0 * kStep_deg);
  return {at(angle_deg), std::abs(per_degree) * sigma_deg};
}

double AngleSigmaDeg(const Eigen::Vector3f& normal, const Eigen::Vector3f& true_normal) {
  constexpr double kDirection_deg = 1.0;  // EncodeDirection, and one direction per block.
  const float cosine = std::min(1.0F, std::abs(true_normal.dot(normal)));
  // Of two directions in which a normal is off, one changes the angle.
  const double normal_deg = static_cast<double>(std::acos(cosine)) / kRadPerDeg;
  return std::hypot(normal_deg / std::numbers::sqrt2, kDirection_deg);
}

}  // namespace isotherm
