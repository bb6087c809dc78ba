#include "common/radiometry/band_emissivity.h"

#include <algorithm>

#include "common/base/check.h"

namespace isotherm {

BandEmissivity::BandEmissivity(std::span<const IndexSample> samples, const SpectralBand& band,
                               double celsius) {
  CHECK(!samples.empty() && band.min_um > 0.0 && band.max_um > band.min_um);
  const double total = PlanckBandRadiance(celsius, band);
  double from_um = band.min_um;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    // Each sample stands for the wavelengths nearest to it, weighted by what a black body sends
    // there.
    const double half_way_um = i + 1 < samples.size()
                                   ? (samples[i].wavelength_um + samples[i + 1].wavelength_um) / 2.0
                                   : band.max_um;
    const double to_um = std::clamp(half_way_um, from_um, band.max_um);
    if (to_um > from_um) {
      const double weight = PlanckBandRadiance(celsius, {from_um, to_um}) / total;
      parts_.push_back({samples[i].n, samples[i].kappa, weight});
    }
    from_um = to_um;
  }
}

double BandEmissivity::At(double angle_rad) const {
  double reflectivity = 0.0;
  for (const WeightedIndex& part : parts_)
    reflectivity += part.weight * FresnelReflectivity(angle_rad, part.n, part.kappa);
  return std::clamp(1.0 - reflectivity, 0.0, 1.0);
}

}  // namespace isotherm
