#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace isotherm {

/// Says when each block of a volume last changed, for readers that follow a model while it grows:
/// a reader keeps the version of what it has and compares. Thread-bound, with the volume.
class BlockVersions {
 public:
  /// These blocks have changed: they get a version that is newer than all before.
  void Note(std::span<const std::int32_t> blocks);
  /// All blocks may have changed.
  void NoteAll(std::int32_t block_count);
  /// Returns the version of a block; 0 = it was never noted.
  std::uint32_t At(std::int32_t block) const {
    const auto index = static_cast<std::size_t>(block);
    return index < versions_.size() ? versions_[index] : 0;
  }
  /// Returns the newest version; 0 = nothing was noted yet.
  std::uint32_t newest() const { return newest_; }

 private:
  std::vector<std::uint32_t> versions_;
  std::uint32_t newest_ = 0;  ///< Some 70 a second: enough for two years.
};

}  // namespace isotherm
