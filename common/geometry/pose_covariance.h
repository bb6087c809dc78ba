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

/// The covariance of T_c_b = T_c_a * T_a_b from that of T_a_b, if T_c_a is exact; `R_c_a` is its
/// rotation. The twist turns b about its own origin, not about a's, so how far a is from c does not
/// matter: the adjoint has no lever arm.
PoseCovariance Rotated(const PoseCovariance& covariance, const Eigen::Matrix3d& R_c_a);

/// Finite, symmetric, no negative variance and no correlation beyond 1 (with room for rounding).
bool IsCovariance(const PoseCovariance& covariance);

}  // namespace isotherm
