#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "ground/camera_calibration/target.h"

namespace isotherm {

/// A grid that was found among points, by steps from neighbour to neighbour.
struct GrownGrid {
  int columns = 0, rows = 0;
  int points = 0;  ///< In the places of columns x rows.
  /// All features, numbered as on the target's front, if the grid is complete and has the target's
  /// size; else empty.
  std::vector<Eigen::Vector2d> features;
  /// Nearly all places of the grid have a point: no chance pattern of other things.
  bool IsDense() const { return 20 * points >= 17 * columns * rows; }
  bool mirrored = false;  ///< Complete, but only a mirror image of the target looks so.
};

/// Finds the largest grid of the target's kind among points in an image, whatever its size. nullopt
/// if there is none of at least three by three.
std::optional<GrownGrid> GrowGrid(const std::vector<Eigen::Vector2d>& points,
                                  const CalibrationTarget& target);

}  // namespace isotherm
