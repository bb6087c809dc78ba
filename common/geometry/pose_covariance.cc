#include "common/geometry/pose_covariance.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

namespace isotherm {
namespace {

constexpr double kRounding = 1e-6;  // Relative; on the wire the numbers are floats.

double LargestDeviation(const Eigen::Matrix3d& covariance) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(covariance, Eigen::EigenvaluesOnly);
  return std::sqrt(std::max(0.0, solver.eigenvalues()(2)));
}

}  // namespace

PoseSigma LargestSigma(const PoseCovariance& covariance) {
  return {.translation_m = LargestDeviation(covariance.topLeftCorner<3, 3>()),
          .rotation_rad = LargestDeviation(covariance.bottomRightCorner<3, 3>())};
}

PoseCovariance Rotated(const PoseCovariance& covariance, const Eigen::Matrix3d& R_c_a) {
  PoseCovariance adjoint = PoseCovariance::Zero();
  adjoint.topLeftCorner<3, 3>() = R_c_a;
  adjoint.bottomRightCorner<3, 3>() = R_c_a;
  return adjoint * covariance * adjoint.transpose();
}

bool IsCovariance(const PoseCovariance& covariance) {
  if (!covariance.allFinite() || covariance.diagonal().minCoeff() < 0.0) return false;
  for (int i = 0; i < 6; ++i) {
    for (int j = 0; j < i; ++j) {
      const double bound = std::sqrt(covariance(i, i)) * std::sqrt(covariance(j, j));
      if (std::abs(covariance(i, j)) > (1.0 + kRounding) * bound) return false;
      if (std::abs(covariance(i, j) - covariance(j, i)) > kRounding * bound) return false;
    }
  }
  return true;
}

}  // namespace isotherm
