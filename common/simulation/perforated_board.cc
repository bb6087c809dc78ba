#include "common/simulation/perforated_board.h"

#include <cmath>
#include <optional>

namespace isotherm {
namespace {

/// Where the ray is at the depth of the front face plus `behind_m`, from a point of the ray near
/// it. The face bends by so little that each iteration takes away all but some percent of what is
/// left.
Eigen::Vector3d AtDepth(const PerforatedBoard& board, const Eigen::Vector3d& near,
                        const Eigen::Vector3d& direction, double behind_m, int iterations) {
  Eigen::Vector3d p = near;
  for (int i = 0; i < iterations; ++i) {
    const double z = board.FaceZ(p.head<2>()) + behind_m;
    p += direction * ((z - p.z()) / direction.z());
  }
  return p;
}

/// The centre of the hole nearest to `xy`, also just beside the grid.
Eigen::Vector2d NearestCentre(const PerforatedBoard& board, const Eigen::Vector2d& xy) {
  const double s = board.square_m;
  const int middle = static_cast<int>(std::lround(xy.y() / s));
  std::optional<Eigen::Vector2d> nearest;
  for (int row = middle - 1; row <= middle + 1; ++row) {
    const int r = std::min(std::max(row, 0), board.rows - 1);
    const double shift = board.asymmetric && r % 2 == 1 ? s : 0.0;
    const double pitch = board.asymmetric ? 2.0 * s : s;
    const int column = static_cast<int>(std::lround((xy.x() - shift) / pitch));
    const int c = std::min(std::max(column, 0), board.columns - 1);
    const Eigen::Vector2d centre(shift + c * pitch, r * s);
    if (!nearest || (centre - xy).squaredNorm() < (*nearest - xy).squaredNorm()) nearest = centre;
  }
  return *nearest;
}

bool IsOnBoard(const PerforatedBoard& board, const Eigen::Vector2d& xy) {
  const Eigen::Vector2d half = board.HalfSize();
  const double beyond = 0.5 * board.diameters_m[0] + board.margin_m;
  return std::abs(xy.x() - half.x()) <= half.x() + beyond &&
         std::abs(xy.y() - half.y()) <= half.y() + beyond;
}

}  // namespace

Eigen::Vector2d PerforatedBoard::HoleCentre(int hole) const {
  const int row = hole / columns, column = hole % columns;
  if (!asymmetric) return {column * square_m, row * square_m};
  return {(2 * column + row % 2) * square_m, row * square_m};
}

Eigen::Vector2d PerforatedBoard::HalfSize() const {
  const double width = asymmetric ? 2 * columns - 1 : columns - 1;
  return 0.5 * square_m * Eigen::Vector2d(width, rows - 1);
}

double PerforatedBoard::FaceZ(const Eigen::Vector2d& xy) const {
  const Eigen::Vector2d half = HalfSize();
  const double a = (xy.x() - half.x()) / half.x(), b = (xy.y() - half.y()) / half.y();
  return 0.5 * bowl_m * (a * a + b * b) + twist_m * a * b + s_bend_m * b * b * b;
}

double PerforatedBoard::PlateCelsius(const Eigen::Vector2d& xy) const {
  // Hottest beside the middle, cold towards one corner.
  constexpr double kAcross = 0.25, kFall = 0.25;
  const Eigen::Vector2d half = HalfSize();
  const double a = (xy.x() - half.x()) / half.x(), b = (xy.y() - half.y()) / half.y();
  return plate_celsius + plate_uneven_k * (kAcross * (a + 0.5 * b) - kFall * (a * a + b * b));
}

BoardHit CastAtBoard(const PerforatedBoard& board, const Eigen::Vector3d& origin,
                     const Eigen::Vector3d& direction) {
  constexpr int kFromFar = 4, kFromFront = 2;
  const Eigen::Vector3d plane = origin - direction * (origin.z() / direction.z());
  const Eigen::Vector3d front = AtDepth(board, plane, direction, 0.0, kFromFar);
  const Eigen::Vector2d xy = front.head<2>();
  if (!IsOnBoard(board, xy)) return {};
  const Eigen::Vector2d centre = NearestCentre(board, xy);
  const auto is_inside = [&](const Eigen::Vector3d& p, double diameter_m) {
    return (p.head<2>() - centre).squaredNorm() < 0.25 * diameter_m * diameter_m;
  };
  if (!is_inside(front, board.diameters_m[0])) return {BoardSurface::kFace, front};
  // Within a layer the hole is a cylinder: a ray that is inside where it comes in and where it goes
  // out was inside all the way.
  Eigen::Vector3d in = front;
  for (int layer = 0; layer < PerforatedBoard::kLayers; ++layer) {
    const double diameter_m = board.diameters_m[static_cast<std::size_t>(layer)];
    const Eigen::Vector3d out =
        AtDepth(board, in, direction, (layer + 1) * board.layer_m, kFromFront);
    if (!is_inside(in, diameter_m) || !is_inside(out, diameter_m)) return {BoardSurface::kWall, in};
    in = out;
  }
  const double plate_z = PerforatedBoard::kLayers * board.layer_m + board.gap_m;
  return {BoardSurface::kPlate, origin + direction * ((plate_z - origin.z()) / direction.z())};
}

}  // namespace isotherm
