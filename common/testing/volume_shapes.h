#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cstdint>

namespace isotherm::testing {

// Analytic shapes for any block volume with the interface of TsdfVolume. Templates, because common
// must not know the ground's volume.

/// Calls `visit(block_coordinates)` for each block of the grid, x fastest.
template <typename Grid, typename Visit>
void ForEachBlockOfGrid(const Grid& grid, const Visit& visit) {
  for (int z = 0; z < grid.blocks.z(); ++z) {
    for (int y = 0; y < grid.blocks.y(); ++y) {
      for (int x = 0; x < grid.blocks.x(); ++x) visit(Eigen::Vector3i(x, y, z));
    }
  }
}

/// Calls `set(voxel, p_world)` for each voxel of a block, x fastest.
template <typename Voxels, typename Grid, typename Set>
void ForEachVoxel(Voxels voxels, const Grid& grid, const Eigen::Vector3i& block, const Set& set) {
  constexpr int kSide = 8;
  for (int i = 0; i < kSide * kSide * kSide; ++i) {
    const Eigen::Vector3i local(i % kSide, i / kSide % kSide, i / (kSide * kSide));
    set(voxels[static_cast<std::size_t>(i)], grid.VoxelCentre(block * kSide + local));
  }
}

/// Writes `signed_distance_m(p_world)` (positive outside) with `weight` into all voxels within the
/// truncation distance and into the free space in front of them; voxels deeper inside stay
/// unobserved, as after a scan. Blocks farther than the truncation distance from the surface are
/// not allocated.
template <typename Volume, typename SignedDistance>
void FillVolume(Volume& volume, const SignedDistance& signed_distance_m, float weight = 10.0F) {
  const auto grid = volume.grid();
  const double truncation_m = volume.truncation_distance_m();
  const double block_radius_m = grid.block_size_m();  // More than half the diagonal, sqrt(3) / 2.
  ForEachBlockOfGrid(grid, [&](const Eigen::Vector3i& b) {
    const Eigen::Vector3d centre =
        grid.min_m +
        (b.template cast<double>() + Eigen::Vector3d::Constant(0.5)) * grid.block_size_m();
    const double to_surface_m = signed_distance_m(centre);
    if (to_surface_m > truncation_m + block_radius_m) return;
    if (to_surface_m < -truncation_m - block_radius_m) return;
    const std::int32_t block = volume.FindOrAllocate(b);
    ForEachVoxel(volume.voxels(block), grid, b, [&](auto& voxel, const Eigen::Vector3d& p_world) {
      const double distance = signed_distance_m(p_world) / truncation_m;
      if (distance < -1.0) return;
      voxel.Update(static_cast<float>(std::min(distance, 1.0)), weight, weight);
    });
  });
}

template <typename Volume>
void FillSphere(Volume& volume, const Eigen::Vector3d& centre_world, double radius_m,
                float weight = 10.0F) {
  FillVolume(
      volume, [&](const Eigen::Vector3d& p) { return (p - centre_world).norm() - radius_m; },
      weight);
}

/// The half space behind the plane through `point_world`; `normal_world` (unit) points to free
/// space.
template <typename Volume>
void FillPlane(Volume& volume, const Eigen::Vector3d& point_world,
               const Eigen::Vector3d& normal_world, float weight = 10.0F) {
  FillVolume(
      volume, [&](const Eigen::Vector3d& p) { return (p - point_world).dot(normal_world); },
      weight);
}

/// Sets each thermal voxel of each allocated block to `voxel_at(p_world)`.
template <typename Volume, typename ThermalVolume, typename VoxelAt>
void FillThermal(const Volume& volume, ThermalVolume& thermal, const VoxelAt& voxel_at) {
  for (std::int32_t block = 0; block < volume.block_count(); ++block) {
    ForEachVoxel(thermal.voxels(block), volume.grid(), volume.block_coordinates(block),
                 [&](auto& voxel, const Eigen::Vector3d& p_world) { voxel = voxel_at(p_world); });
  }
}

}  // namespace isotherm::testing
