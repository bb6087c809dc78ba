#pragma once

#include <Eigen/Core>

namespace isotherm {

/// The covariance of a pose T_a_b that is off by a small twist in `a`: translation of b's origin x,
/// y, z (metres), then rotation about it (radians, axis-angle), in this order. Row and column i
/// belong to component i.
using PoseCovariance = Eigen::Matrix<double, 6, 6>;

/// One standard deviation along the least certain direction.
struct PoseSigma {
  double translation_m = 0.0;
  double rotation_rad = 0.0;
};
PoseSigma LargestSigma(const PoseCovariance& covariance);

/// Finite, symmetric, no negative variance and no correlation beyond 1 (with room for rounding).
bool IsCovariance(const PoseCovariance& covariance);

}  // namespace isotherm
