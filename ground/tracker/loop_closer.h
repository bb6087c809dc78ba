#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "common/concurrency/thread_pool.h"
#include "ground/atlas/atlas.h"
#include "ground/tracker/rig_tracker.h"

namespace isotherm {

/// Watches for ground that other sub-maps know while the rig is followed in the active one: links
/// them, goes back to one that shows what is in view, or begins a new one when the active one
/// should end. Thread-bound.
class LoopCloser {
 public:
  /// All must outlive the closer.
  LoopCloser(const GroundOptions& options, Atlas& atlas, RigTracker& tracker);

  /// Holds what happened to the sub-maps.
  struct Change {
    bool linked = false;  ///< Sub-maps were joined or moved.
    /// Another one is active now. The tracker has its coordinates already.
    bool switched = false;
  };
  /// After each frame that was tracked and integrated at `T_map_depth`; `blocks_in_view` are those
  /// that it updated.
  Change Update(const PreparedDepth& depth, const RigidTransform& T_map_depth,
                std::span<const std::int32_t> blocks_in_view, ThreadPool& pool);

 private:
  /// A view of the active sub-map that another one seems to have too, once.
  struct Sighting {
    int active = 0;
    int other = 0;
    RigidTransform T_other_active;
  };

  bool LookForKnownGround(const PreparedDepth& depth, const RigidTransform& T_map_depth,
                          ThreadPool& pool);
  std::optional<RigidTransform> VerifyIn(int other, const PreparedDepth& depth,
                                         const RigidTransform& T_map_depth, ThreadPool& pool);
  /// Goes back to a linked sub-map that shows what is in view.
  bool GoBack(const PreparedDepth& depth, const RigidTransform& T_map_depth, ThreadPool& pool);

  const GroundOptions options_;
  Atlas& atlas_;
  RigTracker& tracker_;
  std::uint64_t frames_ = 0;
  std::size_t next_candidate_ = 0;
  std::optional<Sighting> sighting_;
  bool reported_full_ = false;
};

}  // namespace isotherm
