#include "ground/console/group_schedule.h"

#include <algorithm>
#include <limits>

namespace isotherm {
namespace {

/// Blocks without surface are looked at again after this time, which doubles with each look that
/// finds none.
constexpr Nanoseconds kWhileEmpty = std::chrono::milliseconds(100);

}  // namespace

void GroupSchedule::Note(const GroupKey& key, CaptureTime time) {
  Group& group = groups_[key];
  if (group.is_waiting) return;
  group.is_waiting = true;
  group.key = key;
  group.changed = time;
  waiting_.push_back(&group);
}

void GroupSchedule::NoteBlock(int map, const GridIndex& block,
                              const Eigen::Vector3i& blocks_of_grid, CaptureTime time) {
  // Points near the border of a group are made with voxels of the next block.
  const GridIndex low = (block - GridIndex::Ones()).cwiseMax(0) / kGroupBlocks;
  const GridIndex high =
      (block + GridIndex::Ones()).cwiseMin(blocks_of_grid - GridIndex::Ones()) / kGroupBlocks;
  for (int z = low.z(); z <= high.z(); ++z) {
    for (int y = low.y(); y <= high.y(); ++y) {
      for (int x = low.x(); x <= high.x(); ++x) Note({map, x, y, z}, time);
    }
  }
}

void GroupSchedule::SetShown(const GroupKey& key, bool is_shown) {
  Group& group = groups_[key];
  group.looks = is_shown ? 0 : group.looks + 1;
  group.is_shown = is_shown;
}

Nanoseconds GroupSchedule::IntervalOf(const Group& group) const {
  if (group.is_shown) return interval_;
  // The second look finds what one frame was not enough for.
  constexpr int kPatientLooks = 2, kMaxDoublings = 5;
  return std::min(interval_,
                  kWhileEmpty * (1 << std::clamp(group.looks - kPatientLooks, 0, kMaxDoublings)));
}

std::optional<DueGroup> GroupSchedule::Take(SteadyTime now, int active_map,
                                            const Eigen::Vector3d& rig_group, bool may_refresh) {
  // What is in another sub-map is as far as can be.
  constexpr double kElsewhere = 1e6;
  auto best = waiting_.end();
  double best_score = -std::numeric_limits<double>::infinity();
  for (auto entry = waiting_.begin(); entry != waiting_.end(); ++entry) {
    const Group& group = **entry;
    if (group.is_shown && !may_refresh) continue;
    if (group.made && now - *group.made < IntervalOf(group)) continue;
    const GroupKey& key = group.key;
    const double distance =
        key.map == active_map
            ? (Eigen::Vector3d(key.x + 0.5, key.y + 0.5, key.z + 0.5) - rig_group).norm()
            : kElsewhere;
    // Seconds outdated per group side of distance; what shows nothing yet comes before all.
    const double score = group.is_shown && group.made
                             ? ToSeconds(now - *group.made) / (1.0 + distance)
                             : 1e9 - distance;
    if (score <= best_score) continue;
    best_score = score;
    best = entry;
  }
  if (best == waiting_.end()) return std::nullopt;
  Group& group = **best;
  *best = waiting_.back();
  waiting_.pop_back();
  group.is_waiting = false;
  group.made = now;
  return DueGroup{.key = group.key, .changed = group.changed, .is_new = !group.is_shown};
}

}  // namespace isotherm
