#pragma once

#include <Eigen/Core>
#include <map>
#include <optional>
#include <vector>

#include "common/time/time_types.h"
#include "ground/console/group_key.h"

namespace isotherm {

/// Decides which group's surface is made next: first those that were never made, the nearest to
/// the rig first; then those that have changed, no more often than an interval, the longest
/// outdated and nearest first. Owns no clock. Thread-bound.
class GroupSchedule {
 public:
  explicit GroupSchedule(Nanoseconds interval) : interval_(interval) {}

  void Clear() {
    groups_.clear();
    waiting_ = 0;
  }
  /// A block has changed: so may the surface of its group and of those that touch the block.
  void NoteBlock(int map, const GridIndex& block, const Eigen::Vector3i& blocks_of_grid);
  /// Returns the next group to make, which then counts as made; nullopt if none is due.
  std::optional<GroupKey> Take(SteadyTime now, int active_map, const Eigen::Vector3d& rig_group);
  std::size_t waiting() const { return waiting_; }

 private:
  struct Group {
    bool is_waiting = false;
    std::optional<SteadyTime> made;
  };
  void Note(const GroupKey& key);

  const Nanoseconds interval_;
  std::map<GroupKey, Group> groups_;
  std::size_t waiting_ = 0;
};

}  // namespace isotherm
