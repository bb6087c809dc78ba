#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "common/geometry/camera.h"
#include "common/geometry/rigid_transform.h"
#include "ground/tsdf/tsdf_volume.h"

namespace isotherm {

/// The blocks of a volume that a camera may see: those whose bounding sphere meets its pyramid of
/// view, however far, whatever stands before them. Keeps its memory. Thread-compatible.
class VisibleBlocks {
 public:
  /// Lens distortion of `camera` is ignored. Blocks in ascending order.
  std::span<const std::int32_t> Find(const TsdfVolume& volume, const CameraModel& camera,
                                     const RigidTransform& T_map_camera);

 private:
  std::vector<std::int32_t> blocks_;
};

/// Camera coordinates in metres of a block's centre from its coordinates: A b + t.
struct BlockToCamera {
  Eigen::Matrix3f A;
  Eigen::Vector3f t;

  BlockToCamera(const VoxelGrid& grid, const RigidTransform& T_camera_map)
      : A((T_camera_map.linear() * grid.block_size_m()).cast<float>()),
        t((T_camera_map * (grid.min_m + Eigen::Vector3d::Constant(0.5 * grid.block_size_m())))
              .cast<float>()) {}
  /// Half the size of the box around a block, along the camera's axes.
  Eigen::Vector3f HalfExtent() const { return 0.5F * A.cwiseAbs().rowwise().sum(); }
  Eigen::Vector3f Centre(const GridIndex& block) const { return A * block.cast<float>() + t; }
};

/// Radius of the sphere around a block.
inline float BlockRadius(const VoxelGrid& grid) {
  constexpr float kHalfDiagonal = 0.8660254F;
  return kHalfDiagonal * static_cast<float>(grid.block_size_m());
}

/// Returns which of `tiles` tiles of `tile_px` pixels along one axis a coordinate lies in: the
/// first or the last one for what lies beyond, the first for NaN.
inline int TileOf(float pixel, int tile_px, int tiles) {
  const auto last_px = static_cast<float>(tiles * tile_px - 1);
  return pixel > 0.0F ? static_cast<int>(std::min(pixel, last_px)) / tile_px : 0;
}

}  // namespace isotherm
