#pragma once

#include <Eigen/Core>
#include <vector>

#include "common/geometry/rigid_transform.h"
#include "ground/calibration/texture_consistency.h"

namespace isotherm {

/// Holds what tracked poses are off by: small rigid motions of the world, given at times spread
/// evenly over the scan (knots) and linear in between. Thread-compatible.
class TrajectoryDrift {
 public:
  /// A twist: a shift (metres) and a rotation vector (radians) about the surface's middle, world
  /// coordinates.
  static constexpr int kPerKnot = 6;

  /// No knots: poses are taken as right.
  TrajectoryDrift() = default;
  /// Knots about `spacing_s` apart, `max_knots` at most, all zero.
  TrajectoryDrift(const ScanViews& views, double spacing_s, int max_knots);

  /// The number of its values.
  int size() const { return static_cast<int>(values_.size()); }
  const Eigen::VectorXd& values() const { return values_; }
  void Add(const Eigen::VectorXd& change) { values_ += change; }

  /// How far its values are off by: each with this standard deviation (metres, radians), the same
  /// value of two knots alike by as much as poses remember in between (kDriftMemory_s). Returns the
  /// lower triangular matrix that makes such values of independent standard normal ones.
  Eigen::MatrixXd PriorFactor(double sigma_m, double sigma_rad) const;

  /// Where a time lies between two knots.
  struct Place {
    int first = 0;          ///< The first of the kPerKnot values of the knot before.
    double fraction = 0.0;  ///< This part of the way to the next one.
  };
  Place At(CaptureTime time) const;
  /// The motion of the world at this place.
  RigidTransform MotionAt(const Place& place) const;
  /// How a point of the world moves with the values of one knot, if they hold fully.
  Eigen::Matrix<double, 3, kPerKnot> ByKnot(const Eigen::Vector3d& p_world) const;

 private:
  CaptureTime start_;
  double spacing_s_ = 1.0;
  Eigen::Vector3d middle_world_ = Eigen::Vector3d::Zero();
  Eigen::VectorXd values_;
};

}  // namespace isotherm
