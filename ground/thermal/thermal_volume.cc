#include "ground/thermal/thermal_volume.h"

#include <algorithm>
#include <limits>

namespace isotherm {

ThermalVoxel ThermalVoxel::Make(float celsius, ConditionClass distance, ConditionClass angle,
                                ConditionClass motion, ConditionClass disagreement) {
  constexpr float kMaxCode = 65535.0F;
  const float code =
      std::clamp(1.0F + std::round((celsius - kMinCelsius) / kStepKelvin), 1.0F, kMaxCode);
  ThermalVoxel voxel;
  voxel.bits = (static_cast<std::uint32_t>(code) << 16) | (Encode(motion) << kMotionShift) |
               (Encode(disagreement) << kDisagreementShift) |
               (static_cast<std::uint32_t>(distance) << 4) | static_cast<std::uint32_t>(angle);
  return voxel;
}

ThermalVolume::ThermalVolume(std::int32_t max_blocks, const std::filesystem::path& spill_dir)
    : arena_(static_cast<std::size_t>(max_blocks) * kBlockVoxels * sizeof(ThermalVoxel),
             spill_dir) {}

namespace {

ThermalVoxel VoxelAt(const TsdfVolume& tsdf, const ThermalVolume& thermal, const GridIndex& voxel) {
  if ((voxel.array() < 0).any()) return {};
  const std::int32_t block = tsdf.Find(voxel / kBlockSide);
  if (block == TsdfVolume::kNoBlock) return {};
  const auto local = [](int i) { return static_cast<std::size_t>(i % kBlockSide); };
  return thermal.voxels(
      block)[local(voxel.x()) + kBlockSide * (local(voxel.y()) + kBlockSide * local(voxel.z()))];
}

}  // namespace

ThermalVoxel ThermalVoxelAt(const TsdfVolume& tsdf, const ThermalVolume& thermal,
                            const Eigen::Vector3d& p_world) {
  const Eigen::Vector3d p_voxel = tsdf.grid().ToVoxel(p_world);
  const GridIndex centre = p_voxel.array().round().cast<int>();
  const ThermalVoxel own = VoxelAt(tsdf, thermal, centre);
  if (own.measured()) return own;
  ThermalVoxel nearest;
  double nearest_squared = std::numeric_limits<double>::infinity();
  for (int z = -1; z <= 1; ++z) {
    for (int y = -1; y <= 1; ++y) {
      for (int x = -1; x <= 1; ++x) {
        const GridIndex index = centre + GridIndex(x, y, z);
        const double squared = (index.cast<double>() - p_voxel).squaredNorm();
        if (squared >= nearest_squared) continue;
        const ThermalVoxel candidate = VoxelAt(tsdf, thermal, index);
        if (!candidate.measured()) continue;
        nearest = candidate;
        nearest_squared = squared;
      }
    }
  }
  return nearest;
}

}  // namespace isotherm
