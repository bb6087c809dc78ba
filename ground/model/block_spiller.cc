#include "ground/model/block_spiller.h"

#include <algorithm>

namespace isotherm {
namespace {

/// Parts seen within this many frames are never given back: the rig swings.
constexpr std::uint64_t kFramesKept = 15;
/// Looking for parts to give back goes through all parts. Larger: more memory in between (a third
/// of a second of new surface at 30 Hz); smaller: more of that work. Not tuned.
constexpr std::uint64_t kFramesBetweenTrims = 10;

/// 64 blocks of both volumes are 256 kB: at most 4 MB are read ahead at a time.
constexpr int kMaxFetchedParts = 16;

}  // namespace

void BlockSpiller::Touch(std::span<const std::int32_t> blocks) {
  ++frame_;
  for (const std::int32_t block : blocks) {
    const auto i = static_cast<std::size_t>(block / kBlocksPerPart);
    if (i >= parts_.size()) parts_.resize(i + 1);
    Part& part = parts_[i];
    part.last_seen = frame_;
    resident_parts_ += part.resident ? 0 : 1;
    part.resident = true;
  }
}

void BlockSpiller::Trim(const TsdfVolume& tsdf, const ThermalVolume& thermal) {
  if (frame_ % kFramesBetweenTrims != 0 || resident_blocks() <= max_resident_) return;
  std::vector<std::size_t> old;
  for (std::size_t i = 0; i < parts_.size(); ++i) {
    if (parts_[i].resident && parts_[i].last_seen + kFramesKept < frame_) old.push_back(i);
  }
  std::sort(old.begin(), old.end(), [&](std::size_t a, std::size_t b) {
    return parts_[a].last_seen < parts_[b].last_seen;
  });
  for (const std::size_t i : old) {
    if (resident_blocks() <= max_resident_) break;
    const auto first = static_cast<std::int32_t>(i) * kBlocksPerPart;
    tsdf.Decommit(first, kBlocksPerPart);
    thermal.Decommit(first, kBlocksPerPart);
    parts_[i].resident = false;
    parts_[i].fetched = false;
    --resident_parts_;
    spilled_ += kBlocksPerPart;
  }
}

void BlockSpiller::Expect(std::span<const std::int32_t> blocks, const TsdfVolume& tsdf,
                          const ThermalVolume& thermal) {
  int left = kMaxFetchedParts;
  for (const std::int32_t block : blocks) {
    const auto i = static_cast<std::size_t>(block / kBlocksPerPart);
    if (i >= parts_.size() || parts_[i].resident || parts_[i].fetched) continue;
    if (left-- == 0) return;
    const auto first = static_cast<std::int32_t>(i) * kBlocksPerPart;
    tsdf.Fetch(first, kBlocksPerPart);
    thermal.Fetch(first, kBlocksPerPart);
    parts_[i].fetched = true;
    fetched_ += kBlocksPerPart;
  }
}

}  // namespace isotherm
