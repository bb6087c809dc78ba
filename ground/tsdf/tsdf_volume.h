#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <vector>

#include "ground/surface/voxel_grid.h"
#include "ground/tsdf/growing_arena.h"
#include "ground/tsdf/voxel_layout.h"

namespace isotherm {

/// One voxel in 32 bits (TsdfLayout): the truncated signed distance divided by the truncation
/// distance, positive in front of the surface, and the weight of what was observed, 0 = never.
/// Update rule: running weighted average (algorithm 2, line 10).
struct TsdfVoxel {
  static constexpr float kTsdfScale = TsdfLayout::kTsdfScale;
  static constexpr float kWeightScale = TsdfLayout::kWeightScale;

  std::uint32_t bits = 0;

  float tsdf() const {
    return static_cast<float>(TsdfLayout::TsdfCode(bits)) * (1.0F / kTsdfScale);
  }
  float weight() const {
    return static_cast<float>(TsdfLayout::WeightCode(bits)) * (1.0F / kWeightScale);
  }
  bool observed() const { return TsdfLayout::WeightCode(bits) != 0; }
  /// Averages `tsdf` in [-1, 1] with weight `observation_weight` into the voxel; the weight stops
  /// at `max_weight`.
  void Update(float tsdf, float observation_weight, float max_weight);
};
static_assert(sizeof(TsdfVoxel) == 4);

/// Truncated signed distances in sparse 8^3 blocks inside the scan volume. A direct table over the
/// volume's blocks finds a block by its coordinates. Blocks never move, so `voxels` of a block
/// stays valid. Thread-compatible; different blocks may be written by different threads.
///
/// For kernels, the table has a border of one block all around in which there is never a block, and
/// the voxels of block kNoBlock exist and were never observed: a look-up needs no bounds checks.
class TsdfVolume {
 public:
  static constexpr std::int32_t kNoBlock = -1;

  /// `max_blocks` bounds memory; allocation beyond it fails and is counted. With a `spill_dir`, it
  /// bounds the file there.
  TsdfVolume(const VoxelGrid& grid, double truncation_distance_m, std::int32_t max_blocks,
             const std::filesystem::path& spill_dir = {});

  const VoxelGrid& grid() const { return grid_; }
  double truncation_distance_m() const { return truncation_distance_m_; }

  std::int32_t block_count() const { return static_cast<std::int32_t>(coordinates_.size()); }
  std::int32_t max_blocks() const { return max_blocks_; }
  /// Lowers the limit, or raises it again up to that of the constructor.
  void LimitBlocks(std::int32_t max_blocks) {
    max_blocks_ = std::min(max_blocks, reserved_blocks_);
  }
  std::uint64_t refused_blocks() const { return refused_blocks_; }
  const GridIndex& block_coordinates(std::int32_t block) const { return coordinates_[block]; }
  bool InGrid(const GridIndex& b) const {
    return (b.array() >= 0).all() && (b.array() < grid_.blocks.array()).all();
  }
  /// kNoBlock outside the volume or where nothing was observed.
  std::int32_t Find(const GridIndex& b) const {
    return InGrid(b) ? table_[TableIndex(b)] : kNoBlock;
  }
  /// Finds or creates; kNoBlock if the block limit is reached. `b` must be in the grid.
  std::int32_t FindOrAllocate(const GridIndex& b);
  /// The same for an entry of the table that is not in its border.
  std::int32_t FindOrAllocateEntry(std::int32_t entry);

  std::span<TsdfVoxel, kBlockVoxels> voxels(std::int32_t block) {
    return std::span<TsdfVoxel, kBlockVoxels>(base() + std::ptrdiff_t{kBlockVoxels} * block,
                                              kBlockVoxels);
  }
  std::span<const TsdfVoxel, kBlockVoxels> voxels(std::int32_t block) const {
    return std::span<const TsdfVoxel, kBlockVoxels>(base() + std::ptrdiff_t{kBlockVoxels} * block,
                                                    kBlockVoxels);
  }
  /// Gives the memory of blocks back until they are touched again; does nothing without a spill
  /// folder.
  void Decommit(std::int32_t first_block, std::int32_t count) const;
  /// Has blocks that were given back read in the background.
  void Fetch(std::int32_t first_block, std::int32_t count) const;
  /// The voxel at voxel coordinates; a never observed voxel where there is no block.
  TsdfVoxel VoxelAt(const GridIndex& voxel) const;

  /// Returns whether a block can hold observed voxels behind the surface (distance <= 0), so that a
  /// ray may end there. It can until said otherwise.
  bool may_end_rays(std::int32_t block) const { return may_end_rays_[block] != 0; }
  void set_may_end_rays(std::int32_t block, bool value) { may_end_rays_[block] = value ? 1 : 0; }

  /// For kernels: first voxel of block 0, the block table with its border, and coordinates of all
  /// blocks (x y z each; null without a block).
  TsdfVoxel* base() const { return reinterpret_cast<TsdfVoxel*>(arena_.data()) + kBlockVoxels; }
  std::span<const std::int32_t> table() const { return table_; }
  std::int32_t table_stride_y() const { return grid_.blocks.x() + 2; }
  std::int32_t table_stride_z() const { return table_stride_y() * (grid_.blocks.y() + 2); }
  const std::int32_t* coordinates() const {
    return coordinates_.empty() ? nullptr : coordinates_.front().data();
  }
  std::size_t memory_bytes() const;

 private:
  std::size_t TableIndex(const GridIndex& b) const {
    return static_cast<std::size_t>(b.x() + 1) +
           static_cast<std::size_t>(table_stride_y()) * static_cast<std::size_t>(b.y() + 1) +
           static_cast<std::size_t>(table_stride_z()) * static_cast<std::size_t>(b.z() + 1);
  }

  const VoxelGrid grid_;
  const double truncation_distance_m_;
  const std::int32_t reserved_blocks_;
  std::int32_t max_blocks_;
  GrowingArena arena_;
  std::vector<std::int32_t> table_;
  std::vector<GridIndex> coordinates_;
  std::vector<std::uint8_t> may_end_rays_;
  std::uint64_t refused_blocks_ = 0;
};

}  // namespace isotherm
