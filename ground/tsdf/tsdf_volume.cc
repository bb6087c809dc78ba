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
}

GrowingArena::~GrowingArena() { munmap(data_, bytes_); }

TsdfVolume::TsdfVolume(const VoxelGrid& grid, double truncation_distance_m, std::int32_t max_blocks)
    : grid_(grid),
      truncation_distance_m_(truncation_distance_m),
      max_blocks_(max_blocks),
      arena_(static_cast<std::size_t>(max_blocks) * kBlockVoxels * sizeof(TsdfVoxel)),
      table_(static_cast<std::size_t>(grid.block_count()), kNoBlock) {
  CHECK(max_blocks > 0 && max_blocks <= kMaxAddressableBlocks);
}

std::int32_t TsdfVolume::FindOrAllocate(const GridIndex& b) {
  std::int32_t& entry = table_[TableIndex(b)];
  if (entry != kNoBlock) return entry;
  if (block_count() == max_blocks_) {
    ++refused_blocks_;
    return kNoBlock;
  }
  entry = block_count();
  coordinates_.push_back(b);
  return entry;
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
             (kBlockVoxels * sizeof(TsdfVoxel) + sizeof(GridIndex)) +
         table_.size() * sizeof(std::int32_t);
}

}  // namespace isotherm
