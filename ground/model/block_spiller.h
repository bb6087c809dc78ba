#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "ground/thermal/thermal_volume.h"
#include "ground/tsdf/tsdf_volume.h"

namespace isotherm {

/// Keeps the memory of both volumes within a limit, if they have files to spill to: parts that were
/// not in view for longest are given back, and come back from the file when they are touched
/// again. Values are never changed. Thread-bound.
class BlockSpiller {
 public:
  /// At most `max_resident_blocks` of each volume stay in memory, but for what is in view.
  explicit BlockSpiller(std::int32_t max_resident_blocks) : max_resident_(max_resident_blocks) {}

  /// After each depth frame: the blocks that it saw.
  void Touch(std::span<const std::int32_t> blocks);
  /// Gives back what is too much; a few system calls every few frames.
  void Trim(const TsdfVolume& tsdf, const ThermalVolume& thermal);

  /// Blocks that will be in view soon: what of them was given back is read in the background, a
  /// bounded number of them each time.
  void Expect(std::span<const std::int32_t> blocks, const TsdfVolume& tsdf,
              const ThermalVolume& thermal);

  /// For other volumes, of which nothing is in memory yet.
  void Restart() {
    parts_.clear();
    resident_parts_ = 0;
  }

  std::int64_t resident_blocks() const { return resident_parts_ * kBlocksPerPart; }
  /// Blocks that were given back, counted each time.
  std::uint64_t spilled() const { return spilled_; }
  /// Blocks that were read ahead, counted each time.
  std::uint64_t fetched() const { return fetched_; }

 private:
  /// 64 blocks are 128 kB of each volume, whole pages. Larger: more that is not needed stays or is
  /// read; smaller: more system calls. Not tuned.
  static constexpr std::int32_t kBlocksPerPart = 64;

  /// Blocks that were allocated one after the other, so mostly beside each other.
  struct Part {
    std::uint64_t last_seen = 0;
    bool resident = false;
    bool fetched = false;  ///< Since it was given back.
  };

  const std::int64_t max_resident_;
  std::vector<Part> parts_;
  std::uint64_t frame_ = 0;
  std::int64_t resident_parts_ = 0;
  std::uint64_t spilled_ = 0;
  std::uint64_t fetched_ = 0;
};

}  // namespace isotherm
