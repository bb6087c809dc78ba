#include "ground/tsdf/tsdf_volume.h"

#include <algorithm>
#include <cmath>
#include <new>

#include "common/base/check.h"

namespace isotherm {
namespace {

constexpr std::size_t kBlockBytes = kBlockVoxels * sizeof(TsdfVoxel);
// The grid limits memory by this, and knows no voxels: one of each volume.
static_assert(sizeof(TsdfVoxel) + sizeof(std::uint32_t) == kBytesPerVoxel);

}  // namespace

void TsdfVoxel::Update(float new_tsdf, float observation_weight, float max_weight) {
  const float old_weight = weight();
  const float total = old_weight + observation_weight;
  const float averaged = (tsdf() * old_weight + new_tsdf * observation_weight) / total;
  const auto tsdf_code = static_cast<std::int32_t>(std::lrint(averaged * kTsdfScale));
  const auto weight_code =
      static_cast<std::uint32_t>(std::lrint(std::min(total, max_weight) * kWeightScale));
  bits = TsdfLayout::Pack(tsdf_code, weight_code);
}

TsdfVolume::TsdfVolume(const VoxelGrid& grid, double truncation_distance_m, std::int32_t max_blocks,
                       const std::filesystem::path& spill_dir)
    : grid_(grid),
      truncation_distance_m_(truncation_distance_m),
      reserved_blocks_(max_blocks),
      max_blocks_(max_blocks),
      arena_((static_cast<std::size_t>(max_blocks) + 1) * kBlockVoxels * sizeof(TsdfVoxel),
             spill_dir),
      // A border of empty entries all around: looking up a neighbour needs no test of bounds.
      table_(static_cast<std::size_t>(grid.blocks.x() + 2) *
                 static_cast<std::size_t>(grid.blocks.y() + 2) *
                 static_cast<std::size_t>(grid.blocks.z() + 2),
             kNoBlock) {
  CHECK(max_blocks > 0 && max_blocks <= kMaxAddressableBlocks);
  if (!arena_.Commit(kBlockBytes)) throw std::bad_alloc();
}

std::int32_t TsdfVolume::FindOrAllocate(const GridIndex& b) {
  return FindOrAllocateEntry(static_cast<std::int32_t>(TableIndex(b)));
}

std::int32_t TsdfVolume::FindOrAllocateEntry(std::int32_t entry) {
  std::int32_t& block = table_[static_cast<std::size_t>(entry)];
  if (block != kNoBlock) return block;
  // One block more than there are is committed: kernels read the empty block before the first one
  // instead of testing for kNoBlock.
  if (block_count() >= max_blocks_ ||
      !arena_.Commit((static_cast<std::size_t>(block_count()) + 2) * kBlockBytes)) {
    ++refused_blocks_;
    return kNoBlock;
  }
  block = block_count();
  coordinates_.emplace_back(entry % table_stride_y() - 1,
                            entry % table_stride_z() / table_stride_y() - 1,
                            entry / table_stride_z() - 1);
  may_end_rays_.push_back(1);
  return block;
}

void TsdfVolume::Decommit(std::int32_t first_block, std::int32_t count) const {
  arena_.Decommit((static_cast<std::size_t>(first_block) + 1) * kBlockBytes,
                  static_cast<std::size_t>(count) * kBlockBytes);
}

void TsdfVolume::Fetch(std::int32_t first_block, std::int32_t count) const {
  arena_.Fetch((static_cast<std::size_t>(first_block) + 1) * kBlockBytes,
               static_cast<std::size_t>(count) * kBlockBytes);
}

TsdfVoxel TsdfVolume::VoxelAt(const GridIndex& voxel) const {
  // Division rounds towards zero, so that -1 would be in block 0.
  if ((voxel.array() < 0).any()) return {};
  const std::int32_t block = Find(voxel / kBlockSide);
  if (block == kNoBlock) return {};
  return voxels(block)[BlockLayout::Element(voxel.x(), voxel.y(), voxel.z())];
}

std::size_t TsdfVolume::memory_bytes() const {
  return static_cast<std::size_t>(block_count()) *
             (kBlockVoxels * sizeof(TsdfVoxel) + sizeof(GridIndex) + 1) +
         table_.size() * sizeof(std::int32_t);
}

}  // namespace isotherm
