#pragma once

#include "common/base/status.h"
#include "common/radiometry/radiometry.h"

namespace isotherm {

/// Describes an opaque surface whose emissivity falls with the angle as its refractive index says
/// (thesis B.2), in surroundings of one temperature.
struct SmoothSurface {
  double normal_emissivity = 1.0;  ///< (0, 1].
  double refractive_index = 1.5;   ///< At least 1.
  double reflected_celsius = 23.0;
  double extinction_coefficient = 0.0;  ///< Not negative; metals have tens.
};

Status Validate(const SmoothSurface& surface);

/// Returns what a camera that assumes a black body shows of a place at `to_rad` from its normal, if
/// it shows `apparent_celsius` at `from_rad`. NaN if a temperature is out of range. Angles are at
/// most 90 degrees; `surface` is valid.
double ApparentAtAngle(const BandRadiance& band, const SmoothSurface& surface,
                       double apparent_celsius, double from_rad, double to_rad);

}  // namespace isotherm
