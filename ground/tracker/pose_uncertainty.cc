#include "ground/tracker/pose_uncertainty.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "ground/tracker/icp_tracker.h"

namespace isotherm {

void PoseUncertainty::Update(const TrackingResult& result, double seconds, double speed_sigma_m_s) {
  const MotionSpace& motion = result.motion;
  const Vector6 to_motion = motion.scale.cwiseInverse();
  Matrix6 covariance = result.covariance;
  for (int i = 0; i < motion.free_axes; ++i) {
    const Vector6 axis = motion.axes.col(i);
    const Vector6 weighted = to_motion.cwiseProduct(axis);
    const double known = std::sqrt(std::max(0.0, weighted.dot(covariance_ * weighted)));
    const double sigma = known + speed_sigma_m_s * std::max(0.0, seconds);
    const Vector6 twist = motion.scale.cwiseProduct(axis);
    covariance += sigma * sigma * twist * twist.transpose();
  }
  covariance_ = covariance;
  mean_depth_m_ = motion.mean_depth_m;
  const Eigen::SelfAdjointEigenSolver<Matrix6> solver(
      to_motion.asDiagonal() * covariance * to_motion.asDiagonal(), Eigen::EigenvaluesOnly);
  surface_sigma_m_ = std::sqrt(std::max(0.0, solver.eigenvalues()(5)));
}

void PoseUncertainty::Rotate(const Eigen::Matrix3d& R) {
  Matrix6 turn = Matrix6::Zero();
  turn.topLeftCorner<3, 3>() = R;
  turn.bottomRightCorner<3, 3>() = R;
  covariance_ = turn * covariance_ * turn.transpose();
}

}  // namespace isotherm
