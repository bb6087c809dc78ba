#include "ground/tsdf/tsdf_volume.h"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

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

GrowingArena::GrowingArena(std::size_t reserve_bytes, const std::filesystem::path& spill_dir)
    : bytes_(reserve_bytes) {
  int flags = MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE;
  if (!spill_dir.empty()) {
    file_ = open(spill_dir.c_str(), O_TMPFILE | O_RDWR | O_CLOEXEC, S_IRUSR | S_IWUSR);
    if (file_ < 0 || ftruncate(file_, static_cast<off_t>(bytes_)) != 0) throw std::bad_alloc();
    flags = MAP_SHARED | MAP_NORESERVE;
  }
  void* memory = mmap(nullptr, bytes_, PROT_READ | PROT_WRITE, flags, file_, 0);
  if (memory == MAP_FAILED) throw std::bad_alloc();
  data_ = static_cast<std::byte*>(memory);
  // Kernels look voxels up all over the arena: large pages save most misses of the address cache.
  // Blocks are taken from the beginning, so they waste less than one such page.
  madvise(memory, bytes_, MADV_HUGEPAGE);
}

GrowingArena::~GrowingArena() {
  munmap(data_, bytes_);
  if (file_ >= 0) close(file_);
}

bool GrowingArena::Commit(std::size_t bytes) {
  constexpr std::size_t kStep = std::size_t{16} << 20;
  if (file_ < 0 || bytes <= committed_bytes_) return true;
  const std::size_t wanted = std::min(bytes_, (bytes + kStep - 1) / kStep * kStep);
  if (posix_fallocate(file_, static_cast<off_t>(committed_bytes_),
                      static_cast<off_t>(wanted - committed_bytes_)) != 0) {
    return false;
  }
  committed_bytes_ = wanted;
  return true;
}

void GrowingArena::Decommit(std::size_t offset, std::size_t bytes) const {
  if (file_ < 0) return;
  const auto page = static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
  const std::size_t begin = (offset + page - 1) / page * page;
  const std::size_t end = (offset + bytes) / page * page;
  // Of a shared file mapping this drops the pages from the process only: the file keeps them.
  if (begin < end) madvise(data_ + begin, end - begin, MADV_DONTNEED);
}

void GrowingArena::Fetch(std::size_t offset, std::size_t bytes) const {
  if (file_ < 0) return;
  const auto page = static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
  const std::size_t begin = offset / page * page;
  const std::size_t end = std::min(bytes_, offset + bytes);
  // Advice: what cannot be read ahead is read when it is touched.
  if (begin < end) madvise(data_ + begin, end - begin, MADV_WILLNEED);
}

TsdfVolume::TsdfVolume(const VoxelGrid& grid, double truncation_distance_m, std::int32_t max_blocks,
                       const std::filesystem::path& spill_dir)
    : grid_(grid),
      truncation_distance_m_(truncation_distance_m),
      reserved_blocks_(max_blocks),
      max_blocks_(max_blocks),
      arena_((static_cast<std::size_t>(max_blocks) + 1) * kBlockVoxels * sizeof(TsdfVoxel),
             spill_dir),
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
