#include "ground/tsdf/tsdf_volume.h"

#include <sys/mman.h>

#include <algorithm>
#include <cmath>
#include <new>

#include "common/base/check.h"

namespace isotherm {

void TsdfVoxel::Update(float new_tsdf, float observation_weight, float max_weight) {
  const float old_weight = weight();
  const float total = old_weight + observation_weight;
  const float averaged = (tsdf() * old_weight + new_tsdf * observation_weight) / total;
  const auto tsdf_code = static_cast<std::int32_t>(std::lrint(averaged * kTsdfScale));
  const auto weight_code =
      static_cast<std::uint32_t>(std::lrint(std::min(total, max_weight) * kWeightScale));
  bits = (static_cast<std::uint32_t>(tsdf_code) << 16) | weight_code;
}

GrowingArena::GrowingArena(std::size_t reserve_bytes) : bytes_(reserve_bytes) {
  void* memory = mmap(nullptr, bytes_, PROT_READ | PROT_WRITE,
                      MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
  if (memory == MAP_FAILED) throw std::bad_alloc();
  data_ = static_cast<std::byte*>(memory);
  // Kernels look voxels up all over the arena: large pages save most misses of the address cache.
  // Blocks are taken from the beginning, so they waste less than one such page.
  madvise(memory, bytes_, MADV_HUGEPAGE);
}

GrowingArena::~GrowingArena() { munmap(data_, bytes_); }

TsdfVolume::TsdfVolume(const VoxelGrid& grid, double truncation_distance_m, std::int32_t max_blocks)
    : grid_(grid),
      truncation_distance_m_(truncation_distance_m),
      max_blocks_(max_blocks),
      arena_((static_cast<std::size_t>(max_blocks) + 1) * kBlockVoxels * sizeof(TsdfVoxel)),
      table_(static_cast<std::size_t>(grid.blocks.x() + 2) *
                 static_cast<std::size_t>(grid.blocks.y() + 2) *
                 static_cast<std::size_t>(grid.blocks.z() + 2),
             kNoBlock) {
  CHECK(max_blocks > 0 && max_blocks <= kMaxAddressableBlocks);
}

std::int32_t TsdfVolume::FindOrAllocate(const GridIndex& b) {
  return FindOrAllocateEntry(static_cast<std::int32_t>(TableIndex(b)));
}

std::int32_t TsdfVolume::FindOrAllocateEntry(std::int32_t entry) {
  std::int32_t& block = table_[static_cast<std::size_t>(entry)];
  if (block != kNoBlock) return block;
  if (block_count() == max_blocks_) {
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

TsdfVoxel TsdfVolume::VoxelAt(const GridIndex& voxel) const {
  if ((voxel.array() < 0).any()) return {};
  const std::int32_t block = Find(voxel / kBlockSide);
  if (block == kNoBlock) return {};
  const auto local = [](int i) { return static_cast<std::size_t>(i % kBlockSide); };
  return voxels(
      block)[local(voxel.x()) + kBlockSide * (local(voxel.y()) + kBlockSide * local(voxel.z()))];
}

std::size_t TsdfVolume::memory_bytes() const {
  return static_cast<std::size_t>(block_count()) *
             (kBlockVoxels * sizeof(TsdfVoxel) + sizeof(GridIndex) + 1) +
         table_.size() * sizeof(std::int32_t);
}

}  // namespace isotherm
