#pragma once

#include <cstdint>
#include <filesystem>
#include <utility>
#include <vector>

#include "common/base/mutex.h"
#include "ground/surface/block_layout.h"
#include "ground/thermal/condition_record.h"
#include "ground/tsdf/growing_arena.h"

namespace isotherm {

/// Records of thermal voxels, in a store of rows of 8 voxels that exist only where a temperature
/// was assigned. Rows of blocks that are spilled together lie in the same pages. Thread-compatible;
/// different blocks may be written by different threads.
class ThermalRecords {
 public:
  static constexpr int kRowsPerBlock = kBlockVoxels / RecordRow::kVoxels;
  /// Blocks whose rows share pages; a multiple of it is given back at once.
  static constexpr std::int32_t kBlocksPerPart = 64;

  ThermalRecords(std::int32_t max_blocks, const std::filesystem::path& spill_dir);

  /// nullptr if the row was never written.
  const RecordRow* Find(std::int32_t block, int row) const;
  RecordRow* Find(std::int32_t block, int row) {
    return const_cast<RecordRow*>(std::as_const(*this).Find(block, row));
  }
  /// Finds or makes it.
  RecordRow& Row(std::int32_t block, int row);

  /// To be called before rows of blocks up to this number are made. False if the disk is full.
  bool Commit(std::int32_t blocks);
  void Decommit(std::int32_t first_block, std::int32_t count) const;
  /// Has rows that were given back read in the background.
  void Fetch(std::int32_t first_block, std::int32_t count) const;
  /// Bytes of all rows, in memory or spilled.
  std::size_t memory_bytes() const {
    const MutexLock lock(mutex_);
    return page_count_ * kPageBytes;
  }

 private:
  static constexpr std::uint32_t kRowsPerPage = 32;
  static constexpr std::size_t kPageBytes = 4096;
  static_assert(kRowsPerPage * sizeof(RecordRow) == kPageBytes);

  struct Part {
    std::vector<std::uint32_t> pages;
    std::uint32_t used = 0;  ///< Rows of the last page.
  };
  std::uint32_t& Entry(std::int32_t block, int row) const {
    return reinterpret_cast<std::uint32_t*>(
        index_.data())[static_cast<std::size_t>(block) * kRowsPerBlock +
                       static_cast<std::size_t>(row)];
  }
  RecordRow& RowAt(std::uint32_t entry) const;
  /// Calls `visit(page)` for the pages of blocks first_block to first_block + count - 1.
  template <typename Visit>
  void ForPages(std::int32_t first_block, std::int32_t count, const Visit& visit) const;

  GrowingArena index_;  ///< Per block and row: 0 = none, else page * kRowsPerPage + row + 1.
  GrowingArena pages_;
  mutable Mutex mutex_;  ///< Taken once per new row.
  std::vector<Part> parts_ GUARDED_BY(mutex_);
  std::uint32_t page_count_ GUARDED_BY(mutex_) = 0;
};

}  // namespace isotherm
