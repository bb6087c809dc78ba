#include "ground/atlas/map_merger.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <vector>

#include "ground/surface/block_layout.h"
#include "ground/surface/voxel_grid.h"
#include "ground/thermal/thermal_fuser.h"

namespace isotherm {
namespace {

GridIndex BlockOf(const GridIndex& voxel) {
  // Rounds down for negative indices too.
  return voxel.unaryExpr([](int v) { return v >> BlockLayout::kSideBits; });
}

std::size_t OffsetInBlock(const GridIndex& voxel) {
  return static_cast<std::size_t>(BlockLayout::Element(voxel.x(), voxel.y(), voxel.z()));
}

struct Sample {
  float tsdf = 0.0F;
  float weight = 0.0F;
};

/// Returns the distance at continuous voxel coordinates; nullopt where a neighbour that counts was
/// never observed. The weight is the neighbours' smallest: an interpolated value is no better known
/// than its worst part.
std::optional<Sample> SampleDistance(const TsdfVolume& volume, const Eigen::Vector3d& voxel) {
  const GridIndex low = voxel.array().floor().cast<int>();
  const Eigen::Vector3d fraction = voxel - low.cast<double>();
  double tsdf = 0.0;
  float weight = std::numeric_limits<float>::max();
  for (int corner = 0; corner < 8; ++corner) {
    const GridIndex step(corner & 1, (corner >> 1) & 1, corner >> 2);
    double part = 1.0;
    for (int axis = 0; axis < 3; ++axis)
      part *= step[axis] == 1 ? fraction[axis] : 1.0 - fraction[axis];
    constexpr double kNothing = 1e-6;  // On a voxel's centre but for rounding.
    if (part < kNothing) continue;
    const TsdfVoxel neighbour = volume.VoxelAt(low + step);
    // A distance towards unobserved space would be invented, and would grow a rim around the
    // source's surface.
    if (!neighbour.observed()) return std::nullopt;
    tsdf += part * neighbour.tsdf();
    weight = std::min(weight, neighbour.weight());
  }
  return Sample{static_cast<float>(tsdf), weight};
}

/// Allocates the blocks of the target that the source's blocks reach, and returns them.
std::vector<std::int32_t> AllocateReached(const PlacedVolume& source, TsdfVolume& target) {
  std::vector<std::int32_t> reached;
  std::vector<bool> known(static_cast<std::size_t>(target.grid().block_count()), false);
  const VoxelGrid& grid = source.tsdf.grid();
  for (std::int32_t block = 0; block < source.tsdf.block_count(); ++block) {
    Eigen::AlignedBox3d box;
    for (int corner = 0; corner < 8; ++corner) {
      const GridIndex step(corner & 1, (corner >> 1) & 1, corner >> 2);
      const GridIndex voxel = (source.tsdf.block_coordinates(block) + step) * kBlockSide - step;
      box.extend(target.grid().ToVoxel(source.T_target_source * grid.VoxelCentre(voxel)));
    }
    // Half a voxel of rounding must not reach for blocks that nothing of the source touches.
    constexpr double kRounding = 1e-6;
    const GridIndex first = BlockOf((box.min().array() + kRounding).ceil().cast<int>());
    const GridIndex last = BlockOf((box.max().array() + kRounding).floor().cast<int>());
    for (int z = first.z(); z <= last.z(); ++z) {
      for (int y = first.y(); y <= last.y(); ++y) {
        for (int x = first.x(); x <= last.x(); ++x) {
          const GridIndex b(x, y, z);
          if (!target.InGrid(b)) continue;
          // Blocks of a turned source overlap in the target: each is allocated and merged once, or
          // its distances would be averaged in twice.
          const auto place = static_cast<std::size_t>(
              x + target.grid().blocks.x() * (y + std::ptrdiff_t{target.grid().blocks.y()} * z));
          if (known[place]) continue;
          known[place] = true;
          const std::int32_t allocated = target.FindOrAllocate(b);
          if (allocated != TsdfVolume::kNoBlock) reached.push_back(allocated);
        }
      }
    }
  }
  return reached;
}

GridIndex VoxelOf(const TsdfVolume& volume, std::int32_t block, int i) {
  return volume.block_coordinates(block) * kBlockSide +
         GridIndex(i % kBlockSide, i / kBlockSide % kBlockSide, i / (kBlockSide * kBlockSide));
}

void MergeDistances(const PlacedVolume& source, float max_weight, std::int32_t block,
                    TsdfVolume& tsdf) {
  const RigidTransform T_source_target = source.T_target_source.inverse();
  const auto voxels = tsdf.voxels(block);
  for (int i = 0; i < kBlockVoxels; ++i) {
    const Eigen::Vector3d at = source.tsdf.grid().ToVoxel(
        T_source_target * tsdf.grid().VoxelCentre(VoxelOf(tsdf, block, i)));
    if (const auto sample = SampleDistance(source.tsdf, at))
      voxels[i].Update(sample->tsdf, sample->weight, max_weight);
  }
}

void MergeTemperatures(const PlacedVolume& source, std::int32_t block, const TsdfVolume& tsdf,
                       ThermalVolume& thermal) {
  const RigidTransform T_source_target = source.T_target_source.inverse();
  const auto voxels = thermal.voxels(block);
  for (int i = 0; i < kBlockVoxels; ++i) {
    const Eigen::Vector3d at = source.tsdf.grid().ToVoxel(
        T_source_target * tsdf.grid().VoxelCentre(VoxelOf(tsdf, block, i)));
    // The nearest voxel and not a mean: temperatures of different conditions are never averaged.
    const GridIndex nearest = (at.array() + 0.5).floor().cast<int>();
    const std::int32_t from = source.tsdf.Find(BlockOf(nearest));
    if (from == TsdfVolume::kNoBlock) continue;
    const auto offset = static_cast<int>(OffsetInBlock(nearest));
    const ThermalVoxel other = source.thermal.voxels(from)[offset];
    const SigmaPair sigma{.now = source.thermal.sigma_code(from, offset),
                          .before = thermal.sigma_code(block, i),
                          .difference_k = double{other.celsius()} - double{voxels[i].celsius()}};
    if (!other.measured() || !ReplacesMeasurement(other.distance_class(), other.angle_class(),
                                                  other.motion_class(), voxels[i], sigma)) {
      continue;
    }
    voxels[i] = other;
    // The record's directions are turned into the target's axes.
    AdoptRecord(source.thermal, {from, offset}, source.T_target_source.linear().cast<float>(),
                thermal, {block, i});
  }
}

}  // namespace

bool MergeVolume(const PlacedVolume& source, float max_weight, ThreadPool& pool, TsdfVolume& tsdf,
                 ThermalVolume& thermal) {
  CHECK(source.tsdf.grid().voxel_size_m == tsdf.grid().voxel_size_m);
  const std::vector<std::int32_t> reached = AllocateReached(source, tsdf);
  const bool has_room = thermal.Commit(tsdf.block_count());
  // Resampling a block costs more than integrating one: smaller tasks balance better. Not tuned.
  constexpr int kBlocksPerTask = 16;
  const int count = static_cast<int>(reached.size());
  // Tasks write disjoint blocks of the target and only read the source, so that the result does not
  // depend on the number of threads.
  pool.ParallelFor((count + kBlocksPerTask - 1) / kBlocksPerTask, [&](int task) {
    const int end = std::min(count, (task + 1) * kBlocksPerTask);
    for (int i = task * kBlocksPerTask; i < end; ++i) {
      MergeDistances(source, max_weight, reached[i], tsdf);
      if (has_room) MergeTemperatures(source, reached[i], tsdf, thermal);
    }
  });
  for (const std::int32_t block : reached) tsdf.set_may_end_rays(block, true);
  return has_room;
}

}  // namespace isotherm
