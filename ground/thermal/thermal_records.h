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

  /// SigmaCodes of the temperatures of a row that was written, else nullptr.
  const std::uint8_t* FindSigmas(std::int32_t block, int row) const {
    const std::uint32_t entry = Entry(block, row);
    return entry == 0 ? nullptr : SigmasAt(entry);
  }
  /// The same of a row that was written (DCHECK: called for each voxel that is measured).
  std::uint8_t* Sigmas(std::int32_t block, int row);

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
  static constexpr std::size_t kPageBytes = 4096;
  static constexpr std::uint32_t kRowsPerPage =
      kPageBytes / (sizeof(RecordRow) + sizeof(std::uint8_t) * RecordRow::kVoxels);
  /// Sigmas lie together: whoever asks for those of a block touches few lines of memory.
  struct Page {
    RecordRow rows[kRowsPerPage];
    std::uint8_t sigmas[kRowsPerPage][RecordRow::kVoxels];
  };
  static_assert(sizeof(Page) <= kPageBytes);
  /// Numbers that a page takes of the index, a power of two: a few stand for no row.
  static constexpr std::uint32_t kPageEntries = 32;
  static_assert(kRowsPerPage <= kPageEntries);

  /// Holds the pages of the rows of neighbouring blocks.
  struct Part {
    std::vector<std::uint32_t> pages;
    std::uint32_t used = 0;  ///< Rows of the last page.
  };
  std::uint32_t& Entry(std::int32_t block, int row) const {
    return reinterpret_cast<std::uint32_t*>(
        index_.data())[static_cast<std::size_t>(block) * kRowsPerBlock +
                       static_cast<std::size_t>(row)];
  }
  Page& PageOf(std::uint32_t entry) const {
    return *reinterpret_cast<Page*>(pages_.data() + (entry - 1) / kPageEntries * kPageBytes);
  }
  RecordRow& RowAt(std::uint32_t entry) const {
    return PageOf(entry).rows[(entry - 1) % kPageEntries];
  }
  std::uint8_t* SigmasAt(std::uint32_t entry) const {
    return PageOf(entry).sigmas[(entry - 1) % kPageEntries];
  }
  static std::size_t MaxPages(std::int32_t blocks);
  /// Calls `visit(page)` for the pages of blocks first_block to first_block + count - 1.
  template <typename Visit>
  void ForPages(std::int32_t first_block, std::int32_t count, const Visit& visit) const;

  GrowingArena index_;  ///< Per block and row: 0 = none, else page * kPageEntries + row + 1.
  GrowingArena pages_;
  mutable Mutex mutex_;  ///< Taken once per new row.
  std::vector<Part> parts_ GUARDED_BY(mutex_);
  std::uint32_t page_count_ GUARDED_BY(mutex_) = 0;
};

}  // namespace isotherm
