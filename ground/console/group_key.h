#pragma once

#include <compare>
#include <cstdint>

#include "ground/surface/voxel_grid.h"

namespace isotherm {

/// Blocks along each edge of a group: the part of the surface that is sent as one message.
inline constexpr int kGroupBlocks = 4;
inline constexpr int kGroupVoxels = kGroupBlocks * kBlockSide;

/// Names a cube of kGroupBlocks^3 blocks of a sub-map.
struct GroupKey {
  int map = 0;
  int x = 0, y = 0, z = 0;

  // clang-tidy 14 sees a null pointer in it. NOLINTNEXTLINE(modernize-use-nullptr)
  friend auto operator<=>(const GroupKey&, const GroupKey&) = default;
};

inline GroupKey GroupOf(int map, const GridIndex& block) {
  const GridIndex group = block / kGroupBlocks;
  return {map, group.x(), group.y(), group.z()};
}

/// Centre of a group in `map`, metres.
inline Eigen::Vector3d GroupCentre(const VoxelGrid& grid, const GroupKey& key) {
  const double side_m = kGroupBlocks * grid.block_size_m();
  return grid.min_m + side_m * Eigen::Vector3d(key.x + 0.5, key.y + 0.5, key.z + 0.5);
}

}  // namespace isotherm
