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

/// An image cut into square tiles.
struct ImageTiles {
  int tile_px = 1;
  int columns = 0;
  int rows = 0;
};

/// Says which tiles of a camera's image a block is seen in, if nothing hides it. Thread-compatible.
class BlockTiles {
 public:
  /// Lens distortion of `camera` is ignored.
  BlockTiles(const VoxelGrid& grid, const CameraModel& camera, const RigidTransform& T_map_camera,
             const ImageTiles& tiles)
      : camera_(camera),
        to_camera_(grid, T_map_camera.inverse()),
        radius_(BlockRadius(grid)),
        tiles_(tiles) {}

  /// Returns whether `meets(column, row, depth_m)` for one of the block's tiles, where `depth_m` is
  /// that of the block's centre. False for blocks nearer than any camera sees.
  template <typename Meets>
  bool AnyOf(const GridIndex& block, const Meets& meets) const {
    const Eigen::Vector3f p_camera = to_camera_.Centre(block);
    const float depth_m = p_camera.z();
    if (depth_m < 2.0F * radius_) return false;
    // The corners of a block may be nearer than its centre, and project further out.
    const float extent = radius_ * 1.5F / (depth_m - radius_);
    const float u = camera_.fx * p_camera.x() / depth_m + camera_.cx;
    const float v = camera_.fy * p_camera.y() / depth_m + camera_.cy;
    const int x0 = Column(u - camera_.fx * extent), x1 = Column(u + camera_.fx * extent);
    const int y0 = Row(v - camera_.fy * extent), y1 = Row(v + camera_.fy * extent);
    for (int y = y0; y <= y1; ++y) {
      for (int x = x0; x <= x1; ++x) {
        if (meets(x, y, depth_m)) return true;
      }
    }
    return false;
  }

 private:
  int Column(float pixel) const { return TileOf(pixel, tiles_.tile_px, tiles_.columns); }
  int Row(float pixel) const { return TileOf(pixel, tiles_.tile_px, tiles_.rows); }

  const CameraF camera_;
  const BlockToCamera to_camera_;
  const float radius_;
  const ImageTiles tiles_;
};

}  // namespace isotherm
