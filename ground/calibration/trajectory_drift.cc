#include "ground/calibration/trajectory_drift.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "ground/calibration/image_motion.h"
#include "ground/calibration/thermal_placement.h"

namespace isotherm {

TrajectoryDrift::TrajectoryDrift(const ScanViews& views, double spacing_s, int max_knots)
    : middle_world_(MiddleOfSurface(views)) {
  if (views.frames.empty()) return;
  start_ = views.frames.front().time;
  const double length_s = ToSeconds(views.frames.back().time - start_);
  const int intervals =
      std::clamp(static_cast<int>(std::lround(length_s / spacing_s)), 1, max_knots - 1);
  spacing_s_ = length_s > 0.0 ? length_s / intervals : 1.0;
  values_ = Eigen::VectorXd::Zero(kPerKnot * (intervals + 1));
}

Eigen::MatrixXd TrajectoryDrift::PriorFactor(double sigma_m, double sigma_rad) const {
  const int knots = size() / kPerKnot;
  Eigen::MatrixXd factor = Eigen::MatrixXd::Zero(size(), size());
  // Cholesky's factor of the covariance sigma^2 alike^|i - j| in closed form (AR(1)).
  const double alike = std::exp(-spacing_s_ / kDriftMemory_s);
  for (int column = 0; column < knots; ++column) {
    double share = column == 0 ? 1.0 : std::sqrt(1.0 - alike * alike);
    for (int row = column; row < knots; ++row, share *= alike) {
      for (int i = 0; i < kPerKnot; ++i)
        factor(kPerKnot * row + i, kPerKnot * column + i) = share * (i < 3 ? sigma_m : sigma_rad);
    }
  }
  return factor;
}

TrajectoryDrift::Place TrajectoryDrift::At(CaptureTime time) const {
  const int intervals = size() / kPerKnot - 1;
  if (intervals < 1) return {};
  const double at = std::clamp(ToSeconds(time - start_) / spacing_s_, 0.0, 1.0 * intervals);
  const int knot = std::min(static_cast<int>(at), intervals - 1);
  return {kPerKnot * knot, at - knot};
}

RigidTransform TrajectoryDrift::MotionAt(const Place& place) const {
  if (size() == 0) return RigidTransform::Identity();
  const Eigen::Matrix<double, kPerKnot, 1> values =
      (1.0 - place.fraction) * values_.segment<kPerKnot>(place.first) +
      place.fraction * values_.segment<kPerKnot>(place.first + kPerKnot);
  RigidTransform motion = TransformFromTwist(values);
  motion.translation() += middle_world_ - motion.linear() * middle_world_;
  return motion;
}

Eigen::Matrix<double, 3, TrajectoryDrift::kPerKnot> TrajectoryDrift::ByKnot(
    const Eigen::Vector3d& p_world) const {
  Eigen::Matrix<double, 3, kPerKnot> by_knot;
  by_knot << Eigen::Matrix3d::Identity(), DerivativeByRotation(p_world - middle_world_);
  return by_knot;
}

}  // namespace isotherm
