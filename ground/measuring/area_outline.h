#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>
#include <vector>

#include "ground/measuring/surface_probe.h"

namespace isotherm {

/// A piece of surface inside an outline: a point of the mesh, and how much of the surface it stands
/// for.
struct AreaPiece {
  const CloudPoint* point = nullptr;
  double area_m2 = 0.0;
};

/// A polygon on the surface, seen along one direction: its inside is what one sees of the surface
/// there from in front, not what lies behind it. In the coordinates of the model.
class AreaOutline {
 public:
  /// At least three corners; `direction` is along the line of sight.
  AreaOutline(std::span<const Eigen::Vector3d> corners, const Eigen::Vector3d& direction);

  /// Calls `visit(piece)` for the surface inside. Points are valid during the call.
  template <typename Visit>
  void ForEachPiece(SurfaceProbe& probe, const Visit& visit) const {
    for (const AreaPiece& piece : Pieces(probe)) visit(piece);
  }
  /// The pieces; points are valid as long as the probe is.
  std::vector<AreaPiece> Pieces(SurfaceProbe& probe) const;

 private:
  struct Candidate;
  class DepthGrid;

  /// (x, y) in the plane of the polygon, z along the line of sight.
  Eigen::Vector3d InPlane(const Eigen::Vector3d& p) const { return axes_ * p; }
  bool MayHold(const VoxelGrid& grid, const GridIndex& block) const;
  std::vector<Candidate> Candidates(SurfaceProbe& probe) const;

  Eigen::Matrix3d axes_;
  std::vector<Eigen::Vector2d> polygon_;
  Eigen::Vector2d low_, high_;                 ///< Corners of a box around the polygon.
  double nearest_m_ = 0.0, farthest_m_ = 0.0;  ///< Along the line of sight.
};

}  // namespace isotherm
