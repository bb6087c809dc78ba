#pragma once

#include <Eigen/Core>
#include <vector>

#include "common/base/status.h"
#include "common/geometry/rigid_transform.h"
#include "ground/camera_calibration/board_shape.h"
#include "ground/camera_calibration/lens_projection.h"
#include "ground/camera_calibration/target.h"

namespace isotherm {

/// A camera as it is being calibrated. The first camera's optical frame is `rig`.
struct BundleCamera {
  LensKind kind = LensKind::kBrownConrady;
  LensParameters lens{};
  RigidTransform T_camera_rig = RigidTransform::Identity();
};

/// Everything that a calibration estimates.
struct BundleState {
  std::vector<BundleCamera> cameras;
  std::vector<RigidTransform> T_rig_board;  ///< By view.
  BoardShape board;
};

/// Says where a camera saw a feature: the projection of its centre, not the centre of its image.
struct FeatureObservation {
  int camera = 0;
  int view = 0;
  int feature = 0;
  Eigen::Vector2d pixel = Eigen::Vector2d::Zero();
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Identity();  ///< Square pixels.
};

struct BundleOptions {
  bool estimate_board = true;  ///< Warp and placement; else the board is taken as drawn and flat.
  /// Residuals beyond this many standard deviations lose weight (Huber).
  double robust_sigmas = 3.0;
  int max_iterations = 100;
  /// Estimates nothing but poses (and the board, if asked for): lenses are known.
  bool fix_lenses = false;
};

/// The normal equations of a solution with the views' poses eliminated: what each view says about
/// the parameters that all views share (lenses, the cameras' poses in the rig, the board). A sum
/// over some of the views, each as often as one likes, with `prior`, is the system of a calibration
/// from them, so that resampling views costs one small solution (one Gauss-Newton step).
struct ReducedSystem {
  struct Term {
    Eigen::MatrixXd hessian;
    Eigen::VectorXd gradient;
  };
  int shared = 0;
  /// The first shared parameter of each camera's lens and, from the second camera on, of its pose:
  /// rotation vector, translation.
  std::vector<int> lens_at, pose_at;
  std::vector<Term> views;
  Term prior;

  /// Covariance of the shared parameters from all views.
  Eigen::MatrixXd Covariance() const;
  /// How far the shared parameters move if view i counts `weights[i]` times.
  Eigen::VectorXd Step(const std::vector<double>& weights) const;
};

/// Says how well a solution fits.
struct BundleFit {
  std::vector<Eigen::Vector2d> residuals_px;  ///< By observation: seen minus predicted.
  /// The observations' squared residuals over what their covariances say, per degree of freedom.
  double variance_factor = 1.0;
  int iterations = 0;
};

/// Pixel at which a camera sees a point of the board: feature `feature` moved by `offset_m` in the
/// board's plane and by `behind_m` along z. NaN behind the camera.
Eigen::Vector2d ProjectBoardPoint(const BundleState& state, const CalibrationTarget& target,
                                  int camera, int view, int feature,
                                  const Eigen::Vector2d& offset_m, double behind_m);

/// Finds the state that explains the observations best, from a state near it. kFailedPrecondition
/// if they cannot be explained (no convergence, or a view without observations).
Result<BundleFit> SolveBundle(const CalibrationTarget& target,
                              const std::vector<FeatureObservation>& observations,
                              const BundleOptions& options, BundleState& state);

/// The reduced normal equations at a solution.
Result<ReducedSystem> ReduceBundle(const CalibrationTarget& target,
                                   const std::vector<FeatureObservation>& observations,
                                   const BundleOptions& options, const BundleState& state);

}  // namespace isotherm
