#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "common/base/status.h"

namespace isotherm {

/// Describes a flat calibration target with features in a grid. Coordinate frame `board`: the first
/// feature is the origin, x along a row, y down the rows, z away from the camera. Metres.
struct CalibrationTarget {
  enum class Pattern {
    kAsymmetricCircles,  ///< Every second row is shifted by half the distance of neighbours.
    kSymmetricCircles,
    kSquareHoles,
    kChessboard,  ///< Features are the inner corners.
  };
  enum class Contrast { kAny, kBright, kDark };  ///< Holes against what is around them.

  Pattern pattern = Pattern::kAsymmetricCircles;
  int columns = 0;  ///< Features in a row: the first number of OpenCV's patternSize.
  int rows = 0;
  /// OpenCV's squareSize: distance of neighbours, of rows in an asymmetric grid, where neighbours
  /// in a row are twice as far apart.
  double square_m = 0.0;
  std::optional<double> hole_m;  ///< Diameter or side; absent: measured in the images.
  double thickness_m = 0.0;      ///< The layer's that the holes are cut into.
  Contrast contrast = Contrast::kAny;
  /// How exactly features were placed, and how far the board may be off a plane; standard
  /// deviations.
  double placement_sigma_m = 1e-4;
  double warp_sigma_m = 2e-3;
  std::string spec;  ///< The text that it was read from.

  int features() const { return columns * rows; }
  bool HasHoles() const { return pattern != Pattern::kChessboard; }
  /// Turned by 180 degrees it looks the same.
  bool IsAmbiguous() const;
  Eigen::Vector2d FeaturePosition(int feature) const;
  /// The middle of the features, and half their extent.
  Eigen::Vector2d Middle() const;
  Eigen::Vector2d HalfSize() const { return Middle(); }
  /// The feature that `feature` becomes in a mirror image of the target; in an asymmetric grid only
  /// if the number of rows is odd.
  std::optional<int> Mirrored(int feature) const;
  /// Returns whether some features tell the pose: eight or more that are not nearly on one line.
  bool TellPose(const std::vector<int>& some) const;
};

/// Reads "PATTERN COLUMNSxROWS SQUARE [hole=M] [thickness=M] [placement=M] [warp=M] [bright|dark]",
/// for example "asymmetric-circles 4x9 0.05", or "thesis-board". Messages say what is wrong and
/// what is expected.
Result<CalibrationTarget> ParseTarget(std::string_view spec);

/// Shows what specifications look like, with a drawing of each pattern, for the help of commands.
std::string_view TargetHelp();

}  // namespace isotherm
