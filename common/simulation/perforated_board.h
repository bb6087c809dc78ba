#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>

namespace isotherm {

/// Describes a calibration target of the thesis's kind (5.2.3, fig. 5.10): layers of cardboard with
/// holes in an asymmetric grid, a hot plate behind them. The defaults are that target. Coordinate
/// frame `board`: the first hole's centre is the origin, x along a row, y down the rows, z away
/// from the camera. Metres and °C.
struct PerforatedBoard {
  int columns = 4;  ///< Holes in a row.
  int rows = 9;
  double square_m = 0.05;  ///< OpenCV's squareSize: half the distance of the holes in a row.
  bool asymmetric = true;  ///< Every second row is shifted by `square_m`; else all are in line, and
                           ///< neighbours are `square_m` apart.
  static constexpr int kLayers = 3;
  std::array<double, kLayers> diameters_m = {0.05, 0.055, 0.06};  ///< Front to back.
  double layer_m = 0.001;                                         ///< Thickness of each layer.
  double gap_m = 0.01;                                            ///< From the back to the plate.
  double margin_m = 0.04;  ///< From the outermost holes' edges to those of the board.

  // What the front face is off a plane, as a distance in z. In each direction the outermost centres
  // are at -1 and 1.
  double bowl_m = 0.0;    ///< At the corners; grows with the square of the distance.
  double twist_m = 0.0;   ///< At the corners; up at two of them, down at the other two.
  double s_bend_m = 0.0;  ///< Along the columns, at their ends; grows with the third power.

  double face_celsius = 27.0;
  double plate_celsius = 60.0;
  double plate_uneven_k = 2.0;  ///< From the coldest part of the plate to the hottest.
  double background_celsius = 23.0;

  int holes() const { return columns * rows; }
  Eigen::Vector2d HoleCentre(int hole) const;
  /// Half the distance between the outermost centres, and where its middle is.
  Eigen::Vector2d HalfSize() const;
  /// Returns z of the front face.
  double FaceZ(const Eigen::Vector2d& xy) const;
  /// Returns the plate's temperature, which is uneven.
  double PlateCelsius(const Eigen::Vector2d& xy) const;
};

enum class BoardSurface : std::uint8_t { kBackground, kFace, kWall, kPlate };

/// Says what a ray meets.
struct BoardHit {
  BoardSurface surface = BoardSurface::kBackground;
  Eigen::Vector3d p_board = Eigen::Vector3d::Zero();
};

/// Returns what the ray from `origin` along `direction` (z > 0), both in `board`, meets first: the
/// face, the wall of a hole, the plate behind it, or nothing of the board.
BoardHit CastAtBoard(const PerforatedBoard& board, const Eigen::Vector3d& origin,
                     const Eigen::Vector3d& direction);

}  // namespace isotherm
