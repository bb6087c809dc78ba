#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <unordered_set>

#include "common/geometry/camera.h"
#include "common/geometry/rigid_transform.h"
#include "ground/surface/voxel_grid.h"

namespace isotherm {

/// Keeps which parts of the scan volume the depth camera has looked at, hidden or not, in cells of
/// some centimetres. Where a known surface ends at a part that it never looked at, the surface may
/// go on: the scan has not seen all of the object yet. Thread-compatible.
class SeenSpace {
 public:
  /// `depth_camera` without distortion; it sees up to `max_depth_m`.
  SeenSpace(const VoxelGrid& grid, const CameraModel& depth_camera, double max_depth_m);

  void Look(const RigidTransform& T_map_depth);
  /// Returns whether a point is in the volume, and the depth camera has never looked there.
  bool IsUnseen(const Eigen::Vector3d& p_map) const;

 private:
  using Cell = Eigen::Array3i;

  Cell CellOf(const Eigen::Vector3d& p_map) const;
  bool IsInside(const Cell& cell) const;

  const Eigen::Vector3d min_m_;
  const Cell size_;
  const CameraModel camera_;
  const double max_depth_m_;
  std::unordered_set<std::uint64_t> seen_;
};

}  // namespace isotherm
