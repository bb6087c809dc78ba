#pragma once

#include <span>
#include <vector>

#include "common/radiometry/radiometry.h"

namespace isotherm {

/// Complex refractive index n + i kappa at one wavelength in vacuum.
struct IndexSample {
  double wavelength_um;
  double n;
  double kappa;
};

/// Emissivity of a smooth opaque body over the angle from its normal, as a camera sees it: one
/// minus the Fresnel reflectivity of unpolarised radiation (thesis 2.2.6, B.2), averaged over the
/// band with the radiance of a black body as weight. The index is taken as constant around each
/// sample, up to half-way to its neighbours and beyond the first and the last. Immutable.
class BandEmissivity {
 public:
  /// `samples` in ascending order of wavelength, at least one. `celsius` is the body's temperature.
  BandEmissivity(std::span<const IndexSample> samples, const SpectralBand& band, double celsius);

  /// 0..1; 0 from 90 degrees.
  double At(double angle_rad) const;

 private:
  /// Holds the complex refractive index n + i kappa of one part of the band.
  struct WeightedIndex {
    double n;
    double kappa;
    double weight;  ///< They sum up to 1.
  };
  std::vector<WeightedIndex> parts_;
};

}  // namespace isotherm
