#pragma once

#include <vector>

#include "common/base/status.h"

namespace isotherm {

/// Wavelengths in which a thermal camera is sensitive; its response is taken as flat in between.
struct SpectralBand {
  double min_um = 7.5;
  double max_um = 13.0;
};

/// Range of BandRadiance. Covers every range of the cameras in use.
inline constexpr double kMinRadiometric_celsius = -100.0;
inline constexpr double kMaxRadiometric_celsius = 1500.0;

/// Radiance of a black body within `band`, W/(m^2 sr): Planck's law (thesis eq. 2.4) integrated by
/// its exact series. Any temperature above absolute zero; slow (use BandRadiance for pixels).
double PlanckBandRadiance(double celsius, const SpectralBand& band);

/// Its derivative with respect to temperature, W/(m^2 sr K).
double PlanckBandRadianceSlope(double celsius, const SpectralBand& band);

/// Black-body radiance within a camera's band and its inverse, from tables (cubic Hermite, error
/// far below 1 mK). Values outside kMinRadiometric_celsius..kMaxRadiometric_celsius give NaN.
/// Building takes a few milliseconds: make one and keep it. Thread-safe (immutable).
class BandRadiance {
 public:
  explicit BandRadiance(const SpectralBand& band = {});

  /// W/(m^2 sr); NaN outside the range.
  double RadianceFromCelsius(double celsius) const;
  /// °C; NaN outside the range.
  double CelsiusFromRadiance(double radiance) const;

  const SpectralBand& band() const { return band_; }

 private:
  /// Holds a support point of a cubic Hermite interpolation.
  struct Knot {
    double value;
    double slope;  ///< Times the knot spacing.
  };
  static double Evaluate(const std::vector<Knot>& table, double position);

  SpectralBand band_;
  std::vector<Knot> radiance_;  ///< Over temperature, uniform.
  std::vector<Knot> celsius_;   ///< Over the logarithm of radiance, uniform.
  double min_radiance_ = 0.0;
  double max_radiance_ = 0.0;
  double min_log_ = 0.0;
  double log_step_ = 0.0;
};

/// Fraction of unpolarised radiation that a smooth surface with the refractive index n + i kappa
/// reflects into the mirror direction, at `angle_rad` from its normal (thesis B.2). Angles beyond
/// 90 degrees give 1.
double FresnelReflectivity(double angle_rad, double n, double kappa);

/// Emissivity of an opaque surface seen at `angle_rad` from its normal: one minus the Fresnel
/// reflectivity, scaled so that it is `normal_emissivity` along the normal. Never above 1.
double DirectionalEmissivity(double angle_rad, double normal_emissivity, double n, double kappa);

/// Returns what a camera that assumes a black body shows for a surface of `true_celsius` and
/// `emissivity` (0..1) that reflects surroundings of `reflected_celsius` (thesis eq. 3.1,
/// integrated over the band). NaN if a temperature is out of range.
double ApparentCelsius(const BandRadiance& band, double true_celsius, double emissivity,
                       double reflected_celsius);

/// The inverse: the surface's temperature from the apparent one. kInvalidArgument if the emissivity
/// is not in (0, 1] or a temperature is out of range; kFailedPrecondition if no temperature in
/// range explains the measurement (colder than the reflection alone).
Result<double> TrueCelsius(const BandRadiance& band, double apparent_celsius, double emissivity,
                           double reflected_celsius);

}  // namespace isotherm
