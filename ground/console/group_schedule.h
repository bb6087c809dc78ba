#pragma once

#include <Eigen/Core>
#include <map>
#include <optional>
#include <vector>

#include "common/time/time_types.h"
#include "ground/console/group_key.h"

namespace isotherm {

/// A group whose surface is to be made.
struct DueGroup {
  GroupKey key;
  CaptureTime changed{};  ///< When it changed first since it was last made.
  bool is_new = false;    ///< It shows no surface so far.
};

/// Decides which group's surface is made next: first those that show none yet, the nearest to the
/// rig first; then those that have changed, no more often than an interval, the longest outdated
/// and nearest first. Owns no clock. Thread-bound.
class GroupSchedule {
 public:
  explicit GroupSchedule(Nanoseconds interval) : interval_(interval) {}

  void Clear() {
    waiting_.clear();
    groups_.clear();
  }
  /// A block has changed with the frame of `time`: so may the surface of its group and of those
  /// that touch the block.
  void NoteBlock(int map, const GridIndex& block, const Eigen::Vector3i& blocks_of_grid,
                 CaptureTime time);
  /// Says whether a group shows a surface, once it is made.
  void SetShown(const GroupKey& key, bool is_shown);
  /// Returns the next group to make, which then counts as made; nullopt if none is due.
  /// `may_refresh`: groups that show surface count, too.
  std::optional<DueGroup> Take(SteadyTime now, int active_map, const Eigen::Vector3d& rig_group,
                               bool may_refresh = true);
  std::size_t waiting() const { return waiting_.size(); }

 private:
  struct Group {
    GroupKey key;
    bool is_waiting = false;
    bool is_shown = false;
    int looks = 0;  ///< Made without a surface, since it showed one.
    CaptureTime changed{};
    std::optional<SteadyTime> made;
  };
  Nanoseconds IntervalOf(const Group& group) const;
  void Note(const GroupKey& key, CaptureTime time);

  const Nanoseconds interval_;
  std::map<GroupKey, Group> groups_;
  std::vector<Group*> waiting_;  ///< In no order.
};

}  // namespace isotherm
