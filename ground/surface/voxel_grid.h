#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "common/base/status.h"
#include "ground/surface/block_layout.h"

namespace isotherm {

class VolumeOptions;

/// Block coordinates, or voxel coordinates where said.
using GridIndex = Eigen::Vector3i;

/// Says where the voxels of the scan volume are. Voxel (i, j, k) has its centre at
/// min_m + (i + 0.5, j + 0.5, k + 0.5) * voxel_size_m in `map`.
struct VoxelGrid {
  Eigen::Vector3d min_m = Eigen::Vector3d::Zero();
  double voxel_size_m = 0.0;
  GridIndex blocks = GridIndex::Zero();  ///< Number of blocks along each axis.

  double block_size_m() const { return voxel_size_m * kBlockSide; }
  Eigen::Vector3d size_m() const { return blocks.cast<double>() * block_size_m(); }
  Eigen::Vector3d max_m() const { return min_m + size_m(); }
  std::int64_t block_count() const { return std::int64_t{blocks.x()} * blocks.y() * blocks.z(); }
  /// Continuous voxel coordinates of a point: voxel centres are at integers.
  Eigen::Vector3d ToVoxel(const Eigen::Vector3d& p_map) const {
    return (p_map - min_m) / voxel_size_m - Eigen::Vector3d::Constant(0.5);
  }
  Eigen::Vector3d VoxelCentre(const GridIndex& voxel) const {
    return min_m + (voxel.cast<double>() + Eigen::Vector3d::Constant(0.5)) * voxel_size_m;
  }
};

/// The grid that covers the volume in `options`, sizes rounded up to whole blocks. Refuses
/// non-finite, empty or absurd volumes with the memory they would need and what would fit
/// (overflow-safe).
Result<VoxelGrid> MakeVoxelGrid(const VolumeOptions& options);

Status Validate(const VolumeOptions& options);

/// Kernels address voxels with 31-bit indices.
inline constexpr std::int32_t kMaxAddressableBlocks = 1 << 22;

/// Blocks that fit into the options' memory limit beside the block table (TSDF and thermal voxels
/// together).
std::int32_t MaxResidentBlocks(const VolumeOptions& options, const VoxelGrid& grid);

/// Blocks that a volume may have: the same, or, with a folder to spill to, any number.
std::int32_t MaxBlocks(const VolumeOptions& options, const VoxelGrid& grid);

}  // namespace isotherm
