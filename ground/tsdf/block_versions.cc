#include "ground/tsdf/block_versions.h"

#include <algorithm>

namespace isotherm {

void BlockVersions::Note(std::span<const std::int32_t> blocks) {
  if (blocks.empty()) return;
  ++newest_;
  const auto needed = static_cast<std::size_t>(std::ranges::max(blocks)) + 1;
  if (versions_.size() < needed) versions_.resize(needed, 0);
  for (const std::int32_t block : blocks) versions_[static_cast<std::size_t>(block)] = newest_;
}

void BlockVersions::NoteAll(std::int32_t block_count) {
  if (block_count <= 0) return;
  versions_.assign(static_cast<std::size_t>(block_count), ++newest_);
}

}  // namespace isotherm
