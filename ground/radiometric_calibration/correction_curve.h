#pragma once

#include <cmath>
#include <vector>

#include "common/base/status.h"
#include "common/rig/radiometric_correction.h"

namespace isotherm {

/// Compares a camera with a black body at one temperature.
struct SetPoint {
  double apparent_celsius = 0.0;  ///< A right camera reads this.
  double reading_celsius = 0.0;
  /// Standard uncertainties of `apparent_celsius`: its own, and that which all set points share.
  double own_sigma_k = 0.0, common_sigma_k = 0.0;
};

/// Tells what set points say of a camera's readings.
struct CurveReport {
  RadiometricCorrection correction;
  int degree = 0;         ///< Degree of the polynomial over the reading.
  double before_k = 0.0;  ///< Root mean square of what is wrong with the readings.
  /// The same once it is corrected by what the others tell; NaN with one set point.
  double held_out_k = 0.0;

  /// Set points that were left out are less wrong once they are corrected; of one, nobody knows.
  bool IsKnown() const { return std::isnan(held_out_k) || held_out_k < before_k; }
};

/// Finds by what readings have to be raised, as a polynomial of degree 0 to 2 of the reading: the
/// least degree that predicts set points that were left out best, so that a line takes three of
/// them and a parabola four. Its uncertainty is that of the fit, of how set points stray about it,
/// and what all of them are off by together. Refuses none, or what makes no curve (Validate).
Result<CurveReport> FitCurve(const std::vector<SetPoint>& points);

}  // namespace isotherm
