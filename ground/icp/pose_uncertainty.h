#pragma once

#include "ground/icp/observability.h"
#include "ground/icp/prior_error.h"

namespace isotherm {

struct TrackingResult;

/// Keeps how uncertain the tracked pose is relative to the model: by what the last frame measured,
/// and along directions that it left free by what was known before, growing with the error of what
/// held them. Thread-compatible.
class PoseUncertainty {
 public:
  /// After each tracked frame, with the error of the prior that held its unobservable directions.
  void Update(const TrackingResult& result, const PriorError& prior);

  /// Goes on in coordinates whose axes are rotated.
  void Rotate(const Eigen::Matrix3d& R_new_old);

  /// Returns the covariance of T_map_depth as a twist (translation, rotation about the camera's
  /// position) in `map`, m and rad.
  const Matrix6& covariance() const { return covariance_; }
  /// One standard deviation of the least certain motion, as the shift of the surface in view,
  /// metres.
  double surface_sigma_m() const { return surface_sigma_m_; }
  /// The depth that is meant, metres.
  double mean_depth_m() const { return mean_depth_m_; }

 private:
  Matrix6 covariance_ = Matrix6::Zero();
  Matrix6 without_noise_ =
      Matrix6::Zero();  ///< The part of the newest pose alone, along unobservable axes.
  double surface_sigma_m_ = 0.0;
  double mean_depth_m_ = 1.0;
};

}  // namespace isotherm
