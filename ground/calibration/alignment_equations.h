#pragma once

#include <Eigen/Core>
#include <vector>

namespace isotherm {

/// Says how the thermal images of a scan disagree about its surface at one placement and drift, and
/// which small corrections of them would make them agree: first the placement's
/// (kPlacementParameters), then the drift's values if they are asked for.
struct AlignmentEquations {
  /// Second and first derivatives of the loss: its minimum is near -information^-1 gradient.
  Eigen::MatrixXd information;
  Eigen::VectorXd gradient;
  std::vector<Eigen::VectorXd> part_gradients;  ///< By part of the scan; `gradient` is their sum.
  int seen_points = 0;                          ///< Points that enough frames show.
  int textured_points = 0;  ///< The temperature changes along the surface at so many of them.
};

}  // namespace isotherm
