#pragma once

#include "ground/renderer/view_maps.h"

namespace isotherm {

class ThermalOptions;

/// Says how well the surface in a view has been measured so far, and how well it could be measured
/// from where the view is taken now. Fractions are of the pixels with a surface and 0 if there are
/// none.
struct CoverageSummary {
  double surface = 0.0;  ///< Pixels with a surface, fraction of the image.
  // These are fractions by what is stored (MeasurementQuality). The four add up to 1 if there is a
  // surface.
  double good = 0.0;
  double acceptable = 0.0;
  double bad = 0.0;
  double never_measured = 0.0;
  // These say why another measurement from here would not be good, for what is not good yet. They
  // may overlap.
  double too_near = 0.0;
  double too_far = 0.0;
  double too_oblique = 0.0;
  double too_frontal = 0.0;  ///< The operator would be reflected.
  /// Only the rig's motion stands in the way: the thermal image would be smeared.
  double too_fast = 0.0;
  double smear_px = 0.0;  ///< Median smear of that part; 0 if there is none.
};

/// Sums up a view. `view`'s distances and angles are those of the thermal camera, to which `limits`
/// apply (CompleteLimits). `smear_px` is SmearInView() of the same pixels; empty = not known.
CoverageSummary SummarizeCoverage(const ViewMaps& view, const Image<float>& smear_px,
                                  const ThermalOptions& limits);

}  // namespace isotherm
