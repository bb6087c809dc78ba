#include "ground/icp/pose_uncertainty.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "common/geometry/pose_covariance.h"
#include "ground/icp/icp_tracker.h"

namespace isotherm {

void PoseUncertainty::Update(const TrackingResult& result, const PriorError& prior) {
  const Observability& motion = result.motion;
  const Vector6 to_motion = motion.scale.cwiseInverse();
  // While one source holds the axis, its jitter of the frame before is gone with that frame; only
  // the growth stays.
  const Matrix6 before = prior.continues ? without_noise_ : covariance_;
  without_noise_ = result.covariance;
  Matrix6 noise = Matrix6::Zero();
  for (int i = 0; i < motion.unobservable_axes; ++i) {
    const Vector6 axis = motion.axes.col(i);
    const auto along_axis = [&](double translation_m, double rotation_rad) {
      return std::hypot(translation_m * axis.head<3>().norm(),
                        rotation_rad * motion.mean_depth_m * axis.tail<3>().norm());
    };
    const Vector6 weighted = to_motion.cwiseProduct(axis);
    const double known = std::sqrt(std::max(0.0, weighted.dot(before * weighted)));
    // Added, not combined as squares: the error of a velocity has the same sense from frame to
    // frame.
    const double sigma = known + along_axis(prior.translation_growth_m, prior.rotation_growth_rad);
    const double jitter = along_axis(prior.translation_noise_m, prior.rotation_noise_rad);
    const Vector6 twist = motion.scale.cwiseProduct(axis);
    const Matrix6 direction = twist * twist.transpose();
    without_noise_ += sigma * sigma * direction;
    noise += jitter * jitter * direction;
  }
  covariance_ = without_noise_ + noise;
  mean_depth_m_ = motion.mean_depth_m;
  // The largest eigenvalue in scaled motions is the shift of the surface along the least certain
  // one.
  const Eigen::SelfAdjointEigenSolver<Matrix6> solver(
      to_motion.asDiagonal() * covariance_ * to_motion.asDiagonal(), Eigen::EigenvaluesOnly);
  surface_sigma_m_ = std::sqrt(std::max(0.0, solver.eigenvalues()(5)));
}

void PoseUncertainty::Rotate(const Eigen::Matrix3d& R_new_old) {
  covariance_ = Rotated(covariance_, R_new_old);
  without_noise_ = Rotated(without_noise_, R_new_old);
}

}  // namespace isotherm
