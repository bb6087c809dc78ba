#include "ground/tracker/loop_closer.h"

#include <fmt/format.h>

#include "common/base/log.h"
#include "common/base/units.h"
#include "ground/relocaliser/relocaliser.h"

namespace isotherm {
namespace {

/// Frames between two looks at other sub-maps. A look takes about as long as tracking a frame: a
/// tenth more time. Fewer: more time; more: a loop is closed later, and a short encounter is
/// missed. Not tuned.
constexpr std::uint64_t kLookEvery = 10;

/// Two sightings in a row must place the sub-maps alike, at the camera. A verified view is right
/// within a millimetre or so, a wrong one is off by anything. Smaller: noisy cameras close no
/// loops; larger: a wrong one may pass, and a closed loop is not opened again. Not tuned.
constexpr double kAgree_m = 0.01;
constexpr double kAgree_rad = 0.01;

/// The fraction of a frame's pixels behind which a sub-map must have a surface to go on in it.
/// Smaller: the rig is handed over to a sub-map at its border and lost; larger: it begins new ones
/// where old ones would do. Not tuned.
constexpr double kShowsView = 0.8;

}  // namespace

LoopCloser::LoopCloser(const GroundOptions& options, Atlas& atlas, RigTracker& tracker)
    : options_(options), atlas_(atlas), tracker_(tracker) {}

std::optional<RigidTransform> LoopCloser::VerifyIn(int other, const PreparedDepth& depth,
                                                   const RigidTransform& T_map_depth,
                                                   ThreadPool& pool) {
  const SubMap& map = atlas_.map(other);
  // Tracking from where the map should be is as cheap as one frame; the search below takes several
  // times as long.
  if (const auto guess = atlas_.PoseIn(other, T_map_depth)) {
    const TrackingResult result = tracker_.Verify(depth, *guess, map, pool);
    if (result.tracked()) return result.T_map_depth;
  }
  // Its place is not known, or the rig has drifted further than the tracker can pull it back.
  if (!options_.relocaliser().expert().enabled()) return std::nullopt;
  const auto guess = map.relocaliser->Find(
      depth, *map.tsdf, static_cast<float>(options_.raycast().expert().min_weight()), pool);
  if (!guess) return std::nullopt;
  const TrackingResult result = tracker_.Verify(depth, *guess, map, pool);
  if (!result.tracked()) return std::nullopt;
  return result.T_map_depth;
}

bool LoopCloser::LookForKnownGround(const PreparedDepth& depth, const RigidTransform& T_map_depth,
                                    ThreadPool& pool) {
  const std::vector<int> candidates = atlas_.ToVerify(T_map_depth);
  if (candidates.empty()) return false;
  // One sighting may be a mistake, and a wrong link bends the whole scan: what was seen last time
  // is looked at again, and linked only if it is at the same place. Otherwise the candidates take
  // turns.
  const bool has_sighting = sighting_ && sighting_->active == atlas_.active_index() &&
                            !atlas_.IsLinked(sighting_->active, sighting_->other);
  const int other =
      has_sighting ? sighting_->other : candidates[next_candidate_++ % candidates.size()];
  const auto pose = VerifyIn(other, depth, T_map_depth, pool);
  if (!pose) {
    sighting_.reset();
    return false;
  }
  const RigidTransform T_other_active = *pose * T_map_depth.inverse();
  const bool agrees =
      has_sighting &&
      TranslationDistance(sighting_->T_other_active * T_map_depth, *pose) < kAgree_m &&
      RotationAngle(sighting_->T_other_active * T_map_depth, *pose) < kAgree_rad;
  sighting_ = Sighting{atlas_.active_index(), other, T_other_active};
  if (!agrees) return false;
  sighting_.reset();
  const bool both_joined = atlas_.active().joined && atlas_.map(other).joined;
  // Both poses are of this frame, so that the link holds at the camera, where both maps know the
  // surface.
  atlas_.Link(other, T_map_depth, *pose);
  if (both_joined) {
    const DriftReport& drift = atlas_.drift();
    LOG(Ground, Info) << fmt::format(
        "sub-map {} sees what sub-map {} has: missed by {:.1f} mm and {:.2f} degrees, now spread "
        "over the sub-maps",
        atlas_.active_index() + 1, other + 1, 1e3 * drift.last_gap_m,
        drift.last_gap_rad / kRadPerDeg);
  } else {
    LOG(Ground, Info) << fmt::format("sub-maps {} and {} are joined: both see the same",
                                     atlas_.active_index() + 1, other + 1);
  }
  return true;
}

bool LoopCloser::GoBack(const PreparedDepth& depth, const RigidTransform& T_map_depth,
                        ThreadPool& pool) {
  for (int other = 0; other < atlas_.size(); ++other) {
    if (other == atlas_.active_index() || !atlas_.IsLinked(other, atlas_.active_index())) continue;
    const auto guess = atlas_.PoseIn(other, T_map_depth);
    // Only where the rig can stay for a while: far from its anchors, the old map would be left
    // again at once.
    if (!guess || atlas_.IsFar(other, *guess) || !atlas_.IsNearView(other, *guess)) continue;
    const TrackingResult result = tracker_.Verify(depth, *guess, atlas_.map(other), pool);
    if (!result.tracked() || result.overlap_ratio < kShowsView) continue;
    // The tracker's poses are of the map that is left; they must be in the new coordinates before
    // that is active.
    tracker_.Rebase(result.T_map_depth * T_map_depth.inverse());
    atlas_.Activate(other);
    return true;
  }
  return false;
}

LoopCloser::Change LoopCloser::Update(const PreparedDepth& depth, const RigidTransform& T_map_depth,
                                      std::span<const std::int32_t> blocks_in_view,
                                      ThreadPool& pool) {
  Change change;
  if (atlas_.size() > 1 && ++frames_ % kLookEvery == 0)
    change.linked = LookForKnownGround(depth, T_map_depth, pool);
  if (!atlas_.IsFar(atlas_.active_index(), T_map_depth)) return change;
  // A known map before a new one: a new one has no surface but what is in view, and takes memory.
  change.switched = GoBack(depth, T_map_depth, pool);
  if (change.switched) return change;
  change.switched = atlas_.Split(T_map_depth, blocks_in_view);
  // Said once: it stays so, and comes again with every frame.
  if (!change.switched && !reported_full_) {
    reported_full_ = true;
    LOG(Ground, Warning)
        << "no sub-map can be begun (submaps.expert.max_maps or memory is reached): the "
           "scan goes on in the last one, with more drift";
  }
  return change;
}

}  // namespace isotherm
