#pragma once

#include <cmath>
#include <functional>

#include "ground/thermal/thermal_volume.h"
#include "ground/tsdf/tsdf_volume.h"

namespace isotherm::testing {

inline constexpr double kTruncation_m = 0.012;

/// A cube of 0.16 m with 4 mm voxels, its corner at `min_m`.
inline VoxelGrid SmallGrid(const Eigen::Vector3d& min_m = Eigen::Vector3d::Zero()) {
  return {min_m, 0.004, GridIndex(5, 5, 5)};
}

inline GridIndex VoxelOfBlock(const TsdfVolume& volume, std::int32_t block, int i) {
  return volume.block_coordinates(block) * kBlockSide + GridIndex(i & 7, (i >> 3) & 7, i >> 6);
}

/// Observes a distance field (metres, positive outside) wherever it is within the truncation
/// distance, in all blocks that have such a voxel; the rest of these blocks stays unobserved.
inline void FillVolume(TsdfVolume& volume,
                       const std::function<double(const Eigen::Vector3d&)>& distance_m,
                       float weight) {
  const VoxelGrid& grid = volume.grid();
  const GridIndex voxels = grid.blocks * kBlockSide;
  for (int z = 0; z < voxels.z(); ++z) {
    for (int y = 0; y < voxels.y(); ++y) {
      for (int x = 0; x < voxels.x(); ++x) {
        const GridIndex voxel(x, y, z);
        const double tsdf = distance_m(grid.VoxelCentre(voxel)) / kTruncation_m;
        if (std::abs(tsdf) > 1.0) continue;
        const std::int32_t block = volume.FindOrAllocate(voxel / kBlockSide);
        volume.voxels(block)[(x & 7) + kBlockSide * ((y & 7) + kBlockSide * (z & 7))].Update(
            static_cast<float>(tsdf), weight, 255.0F);
      }
    }
  }
}

/// A sphere of 4 cm radius.
inline double SphereDistance(const Eigen::Vector3d& p, const Eigen::Vector3d& centre) {
  return (p - centre).norm() - 0.04;
}

}  // namespace isotherm::testing
