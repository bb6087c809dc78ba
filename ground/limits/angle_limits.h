#pragma once

#include "common/base/status.h"
#include "common/radiometry/band_emissivity.h"

namespace isotherm {

struct OpticalMaterial;

/// Holds what is looked at, and what it mirrors.
struct EmissionConditions {
  double object_celsius = 100.0;
  double reflected_celsius = 23.0;  ///< The surroundings, all of one temperature.
  double operator_celsius = 35.0;   ///< Operator and rig, mirrored at small angles.
  double operator_half_width_m = 0.3;
  double distance_m = 0.5;  ///< Between camera and surface.
};

/// Tells how wrong a temperature is that was seen obliquely but interpreted with the emissivity
/// along the normal, which is what an operator sets.
struct EmissionError {
  double emissivity;  ///< At this angle.
  double relative;    ///< emissivity / emissivity along the normal - 1; of the emitted radiance.
  double kelvin;      ///< Interpreted minus true; NaN: outside BandRadiance's range.
};

/// Error that is tolerated, as a ratio of radiance or as a temperature.
struct ErrorTolerance {
  double value = 0.02;
  bool in_kelvin = false;
};

/// This is tolerated where nothing else is said: the default of `isotherm limits`, and what the
/// limits that thermal.material sets stand for. A good angle costs a quarter of an acceptable one.
inline constexpr ErrorTolerance kDefaultTolerance{0.02, false};
inline constexpr double kGoodFraction = 0.25;

/// theta_min, theta_th and theta_max of (6.3b), radians.
struct AngleLimits {
  double min_rad;
  double good_rad;
  double max_rad;
};

/// Holds the same as options state it.
struct AngleLimitsInDegrees {
  double min_deg;
  double good_deg;
  double max_deg;
};

/// Cuts limits to tenths of a degree, on the safe side. A value that is whole but for rounding
/// stays.
AngleLimitsInDegrees InTenthsOfDegrees(const AngleLimits& limits);

/// Returns the limits of a built-in material under the default tolerance, band and
/// EmissionConditions.
AngleLimitsInDegrees AngleLimitsOf(const OpticalMaterial& material);

/// Errors over the emission angle for one material. Immutable.
class EmissionCurve {
 public:
  EmissionCurve(std::span<const IndexSample> material, const SpectralBand& band,
                const EmissionConditions& conditions);

  EmissionError At(double angle_rad) const;
  /// The same along the normal, when what is mirrored there is not the surroundings but the
  /// operator.
  EmissionError WithOperatorMirrored() const;

  /// Angles up to which the error stays within `acceptable` (max) and `good`. The minimum is
  /// OperatorMirrorAngle() if the operator's reflection costs more than `good`, otherwise 0.
  /// kInvalidArgument for tolerances that are not positive or out of order; kFailedPrecondition if
  /// nothing is left between the minimum and the good limit.
  Result<AngleLimits> Limits(const ErrorTolerance& good, const ErrorTolerance& acceptable) const;

 private:
  EmissionError ErrorOf(double emissivity, double reflected_radiance) const;
  double LargestAngle(const ErrorTolerance& tolerance) const;

  const EmissionConditions conditions_;
  const BandEmissivity emissivity_;
  const BandRadiance radiance_;
  const double along_normal_;
};

/// Below this angle a mirror at `distance_m` shows somebody who stands behind the camera and
/// reaches `half_width_m` to each side: the mirrored line of sight leaves at twice the angle. With
/// 0.3 m at 0.5 m it is 15 degrees, the thesis's advice (6.3.3).
double OperatorMirrorAngle(double half_width_m, double distance_m);

}  // namespace isotherm
