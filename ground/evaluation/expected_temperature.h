#pragma once

#include <Eigen/Core>

#include "common/radiometry/radiometry.h"
#include "common/radiometry/smooth_surface.h"

namespace isotherm {

/// Holds the temperature that a camera which takes everything for a black body shows of a place, by
/// the place's true temperature and the angle at which it was measured (thesis eq. 3.1, B.2).
struct ExpectedTemperature {
  double celsius = 0.0;
  double sigma_k = 0.0;  ///< Standard uncertainty, by that of the angle.
};

/// `angle_deg`: to the surface as the model has it; NaN = not known, then along the normal and
/// certain. `sigma_deg`: standard uncertainty of the angle.
ExpectedTemperature ExpectTemperature(const BandRadiance& band, const SmoothSurface& surface,
                                      double true_celsius, double angle_deg, double sigma_deg);

/// Standard uncertainty of an angle to the model's `normal` where `true_normal` is right (both of
/// unit length, either sense), with what the code of the direction adds; degrees.
double AngleSigmaDeg(const Eigen::Vector3f& normal, const Eigen::Vector3f& true_normal);

}  // namespace isotherm
