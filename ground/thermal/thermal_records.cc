#include "ground/thermal/thermal_records.h"

#include <algorithm>

#include "common/base/check.h"

namespace isotherm {
namespace {

constexpr std::size_t kIndexBytes = ThermalRecords::kRowsPerBlock * sizeof(std::uint32_t);

}  // namespace

/// For all rows of the blocks; the last page of a part need not be full.
std::size_t ThermalRecords::MaxPages(std::int32_t blocks) {
  constexpr std::size_t kRowsPerPart = std::size_t{kBlocksPerPart} * kRowsPerBlock;
  constexpr std::size_t kPagesPerPart = (kRowsPerPart + kRowsPerPage - 1) / kRowsPerPage;
  return kPagesPerPart * (static_cast<std::size_t>(blocks) / kBlocksPerPart + 1);
}

ThermalRecords::ThermalRecords(std::int32_t max_blocks, const std::filesystem::path& spill_dir)
    : index_(static_cast<std::size_t>(max_blocks) * kIndexBytes, spill_dir),
      pages_(MaxPages(max_blocks) * kPageBytes, spill_dir),
      parts_(static_cast<std::size_t>(max_blocks / kBlocksPerPart) + 1) {}

const RecordRow* ThermalRecords::Find(std::int32_t block, int row) const {
  const std::uint32_t entry = Entry(block, row);
  return entry == 0 ? nullptr : &RowAt(entry);
}

RecordRow& ThermalRecords::Row(std::int32_t block, int row) {
  std::uint32_t& entry = Entry(block, row);
  if (entry != 0) return RowAt(entry);
  const MutexLock lock(mutex_);
  Part& part = parts_[static_cast<std::size_t>(block / kBlocksPerPart)];
  if (part.pages.empty() || part.used == kRowsPerPage) {
    part.pages.push_back(page_count_++);
    part.used = 0;
  }
  entry = part.pages.back() * kPageEntries + part.used++ + 1;
  return RowAt(entry);
}

std::uint8_t* ThermalRecords::Sigmas(std::int32_t block, int row) {
  const std::uint32_t entry = Entry(block, row);
  DCHECK(entry != 0);
  return SigmasAt(entry);
}

bool ThermalRecords::Commit(std::int32_t blocks) {
  return index_.Commit(static_cast<std::size_t>(blocks) * kIndexBytes) &&
         pages_.Commit(MaxPages(blocks) * kPageBytes);
}

template <typename Visit>
void ThermalRecords::ForPages(std::int32_t first_block, std::int32_t count,
                              const Visit& visit) const {
  const MutexLock lock(mutex_);
  for (std::int32_t block = first_block; block + kBlocksPerPart <= first_block + count;
       block += kBlocksPerPart) {
    const auto part = static_cast<std::size_t>(block / kBlocksPerPart);
    if (part >= parts_.size()) return;
    for (const std::uint32_t page : parts_[part].pages) visit(page);
  }
}

void ThermalRecords::Decommit(std::int32_t first_block, std::int32_t count) const {
  ForPages(first_block, count,
           [&](std::uint32_t page) { pages_.Decommit(page * kPageBytes, kPageBytes); });
}

void ThermalRecords::Fetch(std::int32_t first_block, std::int32_t count) const {
  ForPages(first_block, count,
           [&](std::uint32_t page) { pages_.Fetch(page * kPageBytes, kPageBytes); });
}

}  // namespace isotherm
