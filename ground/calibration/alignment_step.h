#pragma once

#include <Eigen/Core>

#include "ground/calibration/alignment_equations.h"
#include "ground/calibration/thermal_placement.h"

namespace isotherm {

/// Holds the next correction of a placement and of the drift of its poses, and what is certain.
struct AlignmentStep {
  PlacementVector placement = PlacementVector::Zero();
  Eigen::VectorXd drift;
  double length = 0.0;  ///< The placement's step, in standard deviations of the prior.
  /// The placement's step over what the placement is uncertain by after it (Mahalanobis).
  double in_sigmas = 0.0;
  /// The whole correction's, as certain as it is after this step. The images say nothing of some
  /// directions: these keep the prior's variance.
  PlacementMatrix covariance = PlacementMatrix::Zero();
  int observed_directions = 0;  ///< How many of kPlacementParameters the images tell.

  void Halve() {
    placement *= 0.5;
    drift *= 0.5;
  }
};

/// Holds what is known before the images are looked at, about the placement's correction and the
/// drift: both are zero.
struct AlignmentPrior {
  PlacementVector placement_sigma = PlacementVector::Zero();  ///< Standard deviations.
  /// Makes a drift of independent standard normal values (TrajectoryDrift::PriorFactor).
  Eigen::MatrixXd drift_factor;
};

/// Solves the equations together with the prior, after a correction and a drift so far. Samples are
/// not independent of each other (emissivity, the detector's pattern): how much the gradients of
/// parts of the scan scatter says how much less they tell. Along directions of the placement that
/// the images tell less than twice as certainly as the prior the step leads back to the prior:
/// there the result would be mostly chance. The step is at most one standard deviation of the prior
/// long.
AlignmentStep SolveAlignment(const AlignmentEquations& equations, const AlignmentPrior& prior,
                             const PlacementVector& correction, const Eigen::VectorXd& drift);

}  // namespace isotherm
