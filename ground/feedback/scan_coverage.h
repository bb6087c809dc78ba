#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <vector>

#include "common/concurrency/thread_pool.h"
#include "ground/atlas/atlas.h"
#include "ground/feedback/model_coverage.h"

namespace isotherm {

/// Knows how well the surface of a whole scan is measured, in all its sub-maps. Surface that
/// several joined sub-maps have counts once: in the active one, or else in the oldest that has it,
/// as well measured as in the one that measured most of it well. Which is the same is decided block
/// by block. What is in a sub-map that is not joined may be anything: it counts while the rig is
/// there. Thread-compatible.
class ScanCoverage {
 public:
  /// Voxels lighter than `min_weight` do not count as observed.
  explicit ScanCoverage(float min_weight) : min_weight_(min_weight) {}

  using IsSpilled = std::function<bool(const TsdfVolume& tsdf, std::int32_t block)>;
  /// Measures the next `max_blocks` blocks of the active sub-map (ModelCoverage::Update), and of
  /// one other while it is not known as the rig left it; compares as many of both with the rest.
  /// Not to be called after Atlas::Merge, which takes sub-maps away.
  void Update(const Atlas& atlas, const IsSpilled& is_spilled, int max_blocks, ThreadPool& pool);

  /// Returns the areas of all that counts.
  SurfaceAreas areas() const;
  /// Returns whether each block that counts was measured at least once, and compared since the rig
  /// went to another sub-map or one was joined; false before Update().
  bool complete() const;
  /// Calls `visit(map, coverage)` for each sub-map that counts.
  template <typename Visit>
  void ForEachThatCounts(const Visit& visit) const {
    for (const auto& [map, part] : parts_) {
      if (part.counts) visit(map, part.coverage);
    }
  }
  /// Returns what is known of a sub-map's surface; nullptr if nothing is.
  const ModelCoverage* Find(int map) const;

 private:
  struct Part {
    explicit Part(float min_weight) : coverage(min_weight) {}
    ModelCoverage coverage;
    bool counts = true;
    bool is_known = false;
    // It is known with these many turns() and turns_compared().
    std::uint64_t turns_wanted = 1;
    std::uint64_t turns_compared_wanted = 1;
  };

  void NoteChanges(const Atlas& atlas);
  /// Compares the next blocks of a sub-map with all others.
  void Compare(const Atlas& atlas, int map, int max_blocks);

  const float min_weight_;
  std::map<int, Part> parts_;  ///< By sub-map.
  int next_map_ = 0;           ///< The one besides the active that is compared next.
  // These are as of the last update.
  int active_ = 0;
  std::vector<bool> joined_;
};

}  // namespace isotherm
