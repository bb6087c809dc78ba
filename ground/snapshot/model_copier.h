#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "common/time/clock.h"
#include "ground/atlas/atlas.h"
#include "ground/snapshot/block_batch.h"

namespace isotherm {

/// How much a copier may do at once.
struct CopyBudget {
  Nanoseconds time = std::chrono::microseconds(500);
  std::int32_t max_blocks = 1024;
  /// Blocks further from the rig than this are left for later, because looking at them would bring
  /// them back from the disk. Infinite: all blocks are in memory.
  double reach_m = std::numeric_limits<double>::infinity();
};

/// Copies what has changed in a model into batches, a little after each frame, so that the frames
/// hardly wait: first blocks that were never copied, the newest of them first, then the others in
/// turn. Thread-bound, with the model.
class ModelCopier {
 public:
  /// `clock` must outlive it.
  explicit ModelCopier(const Clock& clock) : clock_(clock) {}

  /// A scan begins: nothing of it was copied.
  void Begin(std::uint64_t scan);
  /// Fills `batch` with blocks of the active sub-map or, if nothing has changed there, of another
  /// one. Returns whether there are any.
  bool Copy(const Atlas& atlas, const RigidTransform& T_map_depth, const CopyBudget& budget,
            BlockBatch& batch);

 private:
  struct MapState {
    std::vector<std::uint32_t> copied;    ///< Version of each block that was copied; 0 = none.
    std::int32_t never_copied_above = 0;  ///< All blocks below were copied once.
    std::int32_t cursor = 0;              ///< Where the next turn begins.
  };
  class Turn;

  bool CopyMap(const SubMap& map, MapState& state, Turn& turn);

  const Clock& clock_;
  std::uint64_t scan_ = 0;
  std::vector<MapState> maps_;
};

}  // namespace isotherm
