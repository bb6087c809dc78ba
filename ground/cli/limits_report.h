#pragma once

#include <optional>
#include <string>
#include <vector>

#include "ground/limits/angle_limits.h"
#include "ground/limits/distance_limits.h"

namespace isotherm {

/// A material as `isotherm limits` looks at it.
struct AngleRequest {
  std::string name;
  std::vector<IndexSample> index;
  SpectralBand band;
  EmissionConditions conditions;
  ErrorTolerance good, acceptable;
};

/// The built-in materials with their emissivity along the normal in `band`.
std::string ListMaterials(const SpectralBand& band);

/// Emissivity and its errors every 5 degrees.
std::string DescribeCurve(const AngleRequest& request, const EmissionCurve& curve);
std::string DescribeLimits(const AngleRequest& request, const AngleLimits& limits);

/// Distances of interest to what a pixel sees there, straight on and tilted.
std::string DescribeFootprints(double ifov_rad, const std::vector<double>& distances_m);

/// The limits as --set options and as a piece of a configuration file; what is absent, infinite or
/// zero is left out. Minima are rounded up, the others down, to 0.1 degrees and 1 mm.
struct LimitOptions {
  std::optional<AngleLimits> angle;
  std::optional<double> distance_min_m, distance_good_m, distance_max_m;
};
std::string DescribeOptions(const LimitOptions& limits);

}  // namespace isotherm
