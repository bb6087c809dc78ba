#include "ground/limits/angle_limits.h"

#include <fmt/format.h>

#include <cmath>

#include "common/base/units.h"

#include "common/base/check.h"
#include "common/radiometry/materials.h"

namespace isotherm {
namespace {

/// NaN (no temperature fits) is beyond every tolerance.
bool Within(const EmissionError& error, const ErrorTolerance& tolerance) {
  return std::abs(tolerance.in_kelvin ? error.kelvin : error.relative) <= tolerance.value;
}

/// `degrees` in whole tenths, by `direction` (std::ceil or std::floor).
double Tenths(double degrees, double (*direction)(double), double rounding) {
  return direction(degrees * 10.0 + rounding) / 10.0;
}

}  // namespace

EmissionCurve::EmissionCurve(std::span<const IndexSample> material, const SpectralBand& band,
                             const EmissionConditions& conditions)
    : conditions_(conditions),
      emissivity_(material, band, conditions.object_celsius),
      radiance_(band),
      along_normal_(emissivity_.At(0.0)) {}

EmissionError EmissionCurve::ErrorOf(double emissivity, double reflected_radiance) const {
  const double object = radiance_.RadianceFromCelsius(conditions_.object_celsius);
  const double assumed = radiance_.RadianceFromCelsius(conditions_.reflected_celsius);
  // (3.1) forward with what is there, and back with what is assumed.
  const double seen = emissivity * object + (1.0 - emissivity) * reflected_radiance;
  const double interpreted = (seen - (1.0 - along_normal_) * assumed) / along_normal_;
  EmissionError error{};
  error.emissivity = emissivity;
  error.relative = (interpreted - object) / (object - assumed);
  error.kelvin = radiance_.CelsiusFromRadiance(interpreted) - conditions_.object_celsius;
  return error;
}

EmissionError EmissionCurve::At(double angle_rad) const {
  EmissionError error = ErrorOf(emissivity_.At(angle_rad),
                                radiance_.RadianceFromCelsius(conditions_.reflected_celsius));
  // The same as above, and defined for an object as warm as its surroundings.
  error.relative = error.emissivity / along_normal_ - 1.0;
  return error;
}

EmissionError EmissionCurve::WithOperatorMirrored() const {
  return ErrorOf(along_normal_, radiance_.RadianceFromCelsius(conditions_.operator_celsius));
}

double EmissionCurve::LargestAngle(const ErrorTolerance& tolerance) const {
  // Finer than any use of a limit: angles are held to a degree at best.
  constexpr double kStep_deg = 0.1;
  // At 90 degrees nothing is emitted and the relative error has no value.
  constexpr double kLast_deg = 89.9;
  double within_deg = 0.0;
  for (int i = 1; i * kStep_deg <= kLast_deg; ++i) {
    if (!Within(At(i * kStep_deg * kRadPerDeg), tolerance)) break;
    within_deg = i * kStep_deg;
  }
  return within_deg * kRadPerDeg;
}

Result<AngleLimits> EmissionCurve::Limits(const ErrorTolerance& good,
                                          const ErrorTolerance& acceptable) const {
  for (const ErrorTolerance& tolerance : {good, acceptable}) {
    if (!(tolerance.value > 0.0 && std::isfinite(tolerance.value))) {
      return Err(InvalidArgument(
          fmt::format("the tolerated error must be positive, got {}", tolerance.value)));
    }
  }
  AngleLimits limits{0.0, LargestAngle(good), LargestAngle(acceptable)};
  if (limits.good_rad > limits.max_rad) {
    return Err(InvalidArgument(
        fmt::format("the limits contradict each other: the error of a good angle (up to {:.1f} "
                    "degrees) must be at most that of an acceptable one (up to {:.1f} degrees)",
                    limits.good_rad / kRadPerDeg, limits.max_rad / kRadPerDeg)));
  }
  if (!Within(WithOperatorMirrored(), good)) {
    limits.min_rad = OperatorMirrorAngle(conditions_.operator_half_width_m, conditions_.distance_m);
  }
  if (limits.min_rad >= limits.good_rad) {
    return Err(FailedPrecondition(fmt::format(
        "the limits contradict each other: the operator is mirrored below {:.1f} degrees, and the "
        "error is too large for a good angle above {:.1f} degrees; tolerate a larger error, or go "
        "farther away",
        limits.min_rad / kRadPerDeg, limits.good_rad / kRadPerDeg)));
  }
  return limits;
}

AngleLimitsInDegrees InTenthsOfDegrees(const AngleLimits& limits) {
  constexpr double kRounding = 1e-8;  // Of tenths: far above that of a double, far below a tenth.
  const auto up = static_cast<double (*)(double)>(std::ceil);
  const auto down = static_cast<double (*)(double)>(std::floor);
  return {limits.min_rad > 0.0 ? Tenths(limits.min_rad / kRadPerDeg, up, -kRounding) : 0.0,
          Tenths(limits.good_rad / kRadPerDeg, down, kRounding),
          Tenths(limits.max_rad / kRadPerDeg, down, kRounding)};
}

AngleLimitsInDegrees AngleLimitsOf(const OpticalMaterial& material) {
  constexpr ErrorTolerance kGood{kGoodFraction * kDefaultTolerance.value,
                                 kDefaultTolerance.in_kelvin};
  const EmissionCurve curve(material.index, SpectralBand{}, EmissionConditions{});
  const Result<AngleLimits> limits = curve.Limits(kGood, kDefaultTolerance);
  CHECK(limits);  // Of each material that is built in; a test looks at all.
  return InTenthsOfDegrees(*limits);
}

double OperatorMirrorAngle(double half_width_m, double distance_m) {
  return std::atan2(half_width_m, distance_m) / 2.0;
}

}  // namespace isotherm
