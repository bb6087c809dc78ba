#pragma once

#include <vector>

#include "common/base/status.h"
#include "common/rig/radiometric_correction.h"

namespace isotherm {

/// One comparison of a camera with a black body.
struct SetPoint {
  double apparent_celsius = 0.0;  ///< A right camera reads this.
  double reading_celsius = 0.0;
  double sigma_k = 0.0;  ///< Standard uncertainty of `apparent_celsius` that is its own.
};

/// Tells what set points say of a camera's readings.
struct CurveReport {
  RadiometricCorrection correction;
  int degree = 0;         ///< Degree of the polynomial over the reading.
  double before_k = 0.0;  ///< Root mean square of what is wrong as measured.
  /// The same once it is corrected by what the others tell; NaN with one set point.
  double held_out_k = 0.0;
};

/// Finds by what readings have to be raised, as a polynomial of degree 0 to 2 of the reading: the
/// least degree that predicts set points that were left out best. Its uncertainty is that of the
/// fit, of how set points stray about it, and `common_sigma_k`, by which all set points may be off
/// together (the black body's certificate). Refuses none, or what makes no curve (Validate).
Result<CurveReport> FitCurve(const std::vector<SetPoint>& points, double common_sigma_k);

}  // namespace isotherm
