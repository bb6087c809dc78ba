#include "ground/tracker/tracker.h"

#include <fmt/format.h>

#include "common/base/check.h"
#include "common/base/log.h"
#include "common/base/stage_timer.h"
#include "ground/tracker/initial_pose.h"

namespace isotherm {

Tracker::Tracker(const GroundOptions& options, const CameraModel& depth_camera,
                 const std::optional<RigidTransform>& initial_pose, Atlas& atlas)
    : options_(options.submaps()),
      initial_pose_(initial_pose),
      atlas_(atlas),
      rig_tracker_(options, depth_camera),
      loop_closer_(options, atlas_, rig_tracker_) {}

RigidTransform Tracker::FirstPose(const PreparedDepth& depth) const {
  // Only the scan's first sub-map can begin at a given pose; a later one begins wherever the rig
  // is.
  if (initial_pose_ && atlas_.size() == 1) return *initial_pose_;
  return PoseFacingCentre(atlas_.active().tsdf->grid(), depth.depth_m);
}

TrackedFrame Tracker::Track(const PreparedDepth& depth, CaptureTime time, ThreadPool& pool) {
  using Outcome = TrackedFrame::Outcome;
  CHECK(pending_ == Pending::kNothing);
  TrackedFrame frame;
  frame.time = time;
  const int map_before = atlas_.active_index();
  // A first frame that left no surface (beside the volume, no returns) is followed by another first
  // one.
  bool is_first = atlas_.active().tsdf->block_count() == 0;
  if (!is_first) {
    frame.tracking = TrackInModel(depth, time, pool);
    if (frame.tracking.tracked()) {
      lost_since_.reset();
    } else if (!lost_since_) {
      // By capture time, not by frames or clocks: a replay decides as the live scan did.
      lost_since_ = time;
    } else {
      is_first = BeginElsewhere(depth, time);
    }
  }
  if (is_first) frame.tracking = rig_tracker_.Begin(depth, time, FirstPose(depth));
  frame.switched = atlas_.active_index() != map_before;
  if (!frame.tracking.tracked()) {
    // The place was not confirmed, so the poses on the way there were wrong, too.
    unconfirmed_.clear();
  } else if (rig_tracker_.state() == RigTracker::State::kConfirming) {
    unconfirmed_.push_back({time, frame.tracking.T_map_depth});
    frame.outcome = Outcome::kUnconfirmed;
  } else {
    frame.outcome = is_first ? Outcome::kFirst : Outcome::kTracked;
  }
  if (frame.outcome != Outcome::kLost)
    pending_ = frame.is_believed() ? Pending::kDecision : Pending::kView;
  return frame;
}

TrackingResult Tracker::TrackInModel(const PreparedDepth& depth, CaptureTime time,
                                     ThreadPool& pool) {
  const bool lost = rig_tracker_.state() == RigTracker::State::kLost;
  const StageTimer timer(lost ? times_.relocalise : times_.track);
  // A rig is most often found where it was lost: that map is searched first, then all in turn, one
  // a frame, so that a lost frame costs the same however many maps there are.
  if (!lost) searched_ = atlas_.active_index();
  TrackingResult result =
      rig_tracker_.Track(depth, time, atlas_.active(), atlas_.map(searched_), pool);
  if (rig_tracker_.found_elsewhere()) {
    atlas_.Activate(searched_);
  } else if (lost) {
    searched_ = (searched_ + 1) % atlas_.size();
  }
  return result;
}

bool Tracker::BeginElsewhere(const PreparedDepth& depth, CaptureTime time) {
  const double limit_s = options_.expert().start_after_lost_s();
  // A hand before the camera is no place to begin at: ten times what tracking needs is 3 % of an
  // image of 640 x 480 pixels. Not tuned.
  constexpr int kMinPixels = 10 * kMinTrackedPixels;
  if (limit_s <= 0.0 || ToSeconds(time - *lost_since_) < limit_s ||
      depth.valid_pixels < kMinPixels || !atlas_.BeginElsewhere()) {
    return false;
  }
  LOG(Ground, Warning) << fmt::format(
      "lost for {:.1f} s: the scan goes on in sub-map {}, which is joined when the rig sees both",
      ToSeconds(time - *lost_since_), atlas_.size());
  lost_since_.reset();
  return true;
}

void Tracker::Accept(const TrackedFrame& frame) {
  CHECK(pending_ == Pending::kDecision);
  pending_ = Pending::kView;
  // Frames that waited for confirmation get this frame's sigma: theirs was not followed while they
  // were only candidates.
  const PoseSigma sigma = LargestSigma(uncertainty().covariance());
  const int map = atlas_.active_index();
  for (const StampedMapPose& pose : unconfirmed_) trajectory_.Add(pose, sigma, map, atlas_);
  unconfirmed_.clear();
  trajectory_.Add({frame.time, frame.tracking.T_map_depth}, sigma, map, atlas_);
}

void Tracker::Reject() {
  CHECK(pending_ == Pending::kDecision);
  pending_ = Pending::kNothing;
  rig_tracker_.Forget();
}

bool Tracker::CloseLoops(const TrackedFrame& frame, const PreparedDepth& depth,
                         std::span<const std::int32_t> blocks_in_view, ThreadPool& pool) {
  CHECK(pending_ == Pending::kView && frame.is_believed());
  // Known views are recorded before loops are closed, in the map that was tracked against: Update
  // may switch maps.
  atlas_.active().relocaliser->Add(frame.tracking.T_map_depth);
  const StageTimer timer(times_.sub_maps);
  const LoopCloser::Change change =
      loop_closer_.Update(depth, frame.tracking.T_map_depth, blocks_in_view, pool);
  // Joined or moved sub-maps take their past poses along.
  if (change.linked) trajectory_.Update(atlas_);
  return change.switched;
}

void Tracker::LookFrom(const RigidTransform& T_map_depth, bool is_young, ThreadPool& pool) {
  CHECK(pending_ != Pending::kDecision);
  pending_ = Pending::kNothing;
  const StageTimer timer(times_.raycast);
  rig_tracker_.LookFrom(T_map_depth, *atlas_.active().tsdf, is_young, pool);
}

void Tracker::Rebase(const RigidTransform& T_new_old) {
  CHECK(pending_ == Pending::kNothing);
  pending_ = Pending::kView;
  rig_tracker_.Rebase(T_new_old);
}

MapPose Tracker::pose() const {
  return {atlas_.active_index(), motion().last()->T_map_depth, uncertainty().covariance()};
}

}  // namespace isotherm
