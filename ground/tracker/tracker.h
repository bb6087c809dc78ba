#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "common/base/stage_stats.h"
#include "common/concurrency/thread_pool.h"
#include "common/frame/frame.h"
#include "common/geometry/camera.h"
#include "common/geometry/map_pose.h"
#include "common/geometry/rigid_transform.h"
#include "ground/atlas/atlas.h"
#include "ground/options/ground_options.pb.h"
#include "ground/tracker/loop_closer.h"
#include "ground/tracker/rig_tracker.h"
#include "ground/tracker/trajectory.h"

namespace isotherm {

/// Tells what the tracker made of a depth frame.
struct TrackedFrame {
  /// Says what the pose of a frame may be used for.
  enum class Outcome : std::uint8_t {
    kLost,
    kUnconfirmed,  ///< Found again, but not believed yet: nothing may be fused.
    kFirst,        ///< The active sub-map has no surface yet: the pose is given, not measured.
    kTracked,
  };
  Outcome outcome = Outcome::kLost;
  CaptureTime time;
  TrackingResult tracking;  ///< In the coordinates of the sub-map it was tracked against.
  bool switched = false;    ///< Another sub-map is active than before the frame.

  bool is_believed() const { return outcome == Outcome::kFirst || outcome == Outcome::kTracked; }
};

/// Holds the times that the tracker's calls took.
struct TrackerTimes {
  StageStats track;
  StageStats relocalise;  ///< Instead of `track` while the rig is lost.
  StageStats sub_maps;
  StageStats raycast;
};

/// Says for each depth frame where the rig is, in which sub-map, and whether that is believed. A
/// rig that is lost is looked for in all sub-maps in turn; if that lasts, the scan goes on in a new
/// one. Poses that are believed make the trajectory. It begins and joins sub-maps, but what is in
/// them is changed by others, between Track and Accept. The order of calls is checked (CHECK):
///
///   Track -> Accept -> [CloseLoops] -> LookFrom      a frame that is believed
///   Track -> Reject                                  a first frame that left no surface
///   Track -> LookFrom                                a pose that is not believed yet
///   Track                                            a rig that is lost
///   [Rebase ->] LookFrom                             when maps are merged
///
/// Thread-bound.
class Tracker {
 public:
  /// `initial_pose` is T_world_depth of the first frame; without one the volume's centre is put on
  /// its optical axis at its median depth. `atlas` must outlive the tracker.
  Tracker(const GroundOptions& options, const CameraModel& depth_camera,
          const std::optional<RigidTransform>& initial_pose, Atlas& atlas);
  /// From now on, temperatures help where the geometry does not suffice.
  void UseThermal(const CameraModel& thermal_camera, const RigidTransform& T_thermal_depth) {
    rig_tracker_.UseThermal(thermal_camera, T_thermal_depth);
  }
  /// Begins as lost, in an active sub-map that has a surface already: the rig is anywhere near its
  /// known views.
  void BeginLost() { rig_tracker_.BeginLost(); }

  /// A valid thermal frame of the camera's size, before the first depth frame after it.
  void AddThermal(ThermalFramePtr frame) { rig_tracker_.AddThermal(std::move(frame)); }
  /// In order of capture time, best before the depth frame that follows it.
  void AddExternalOdometry(const ExternalOdometry& pose) { rig_tracker_.AddExternalOdometry(pose); }

  /// Finds the pose of the next frame.
  TrackedFrame Track(const PreparedDepth& depth, CaptureTime time, ThreadPool& pool);
  /// The frame joins the trajectory, and with it those that led to its being believed.
  void Accept(const TrackedFrame& frame);
  /// A first frame that left no surface: the next one is the first again.
  void Reject();
  /// After Accept of a fully observed frame that was integrated: it becomes a known view, and
  /// sub-maps are joined and begun. `blocks_in_view` are those that the frame updated. True if
  /// another sub-map is active now.
  bool CloseLoops(const TrackedFrame& frame, const PreparedDepth& depth,
                  std::span<const std::int32_t> blocks_in_view, ThreadPool& pool);
  /// Casts the active sub-map from a pose: what the next frame is tracked against. `is_young`: it
  /// is little more than one frame's noise.
  void LookFrom(const RigidTransform& T_map_depth, bool is_young, ThreadPool& pool);
  /// Goes on in other coordinates; LookFrom must be called next.
  void Rebase(const RigidTransform& T_new_old);

  /// The newest pose, in the active sub-map. Only while the motion is known.
  MapPose pose() const;
  const ModelView& view() const { return rig_tracker_.view(); }
  /// The last poses, in the active sub-map; none while the rig is lost.
  const MotionHistory& motion() const { return rig_tracker_.motion(); }
  const PoseUncertainty& uncertainty() const { return rig_tracker_.uncertainty(); }
  bool is_speed_known() const { return rig_tracker_.is_speed_known(); }
  bool is_held_by_odometry() const { return rig_tracker_.is_held_by_odometry(); }
  const OdometryPrior& external_odometry() const { return rig_tracker_.external_odometry(); }
  const Trajectory& trajectory() const { return trajectory_; }
  /// Returns how often the rig was found again.
  std::uint64_t relocalisations() const { return rig_tracker_.relocalisations(); }
  const TrackerTimes& times() const { return times_; }

 private:
  RigidTransform FirstPose(const PreparedDepth& depth) const;
  /// Follows the rig in the active sub-map, or looks for it in the next one whose turn it is.
  TrackingResult TrackInModel(const PreparedDepth& depth, CaptureTime time, ThreadPool& pool);
  /// Lost for long, with something in view: goes on in a sub-map of its own.
  bool BeginElsewhere(const PreparedDepth& depth, CaptureTime time);

  const SubMapOptions options_;
  const std::optional<RigidTransform> initial_pose_;
  Atlas& atlas_;
  RigTracker rig_tracker_;
  LoopCloser loop_closer_;
  Trajectory trajectory_;
  TrackerTimes times_;
  std::optional<CaptureTime> lost_since_;
  int searched_ = 0;                         ///< The sub-map a lost rig is looked for in.
  std::vector<StampedMapPose> unconfirmed_;  ///< Part of the trajectory once believed.
  /// Says what must be called before the next Track.
  enum class Pending : std::uint8_t { kNothing, kDecision, kView };
  Pending pending_ = Pending::kNothing;
};

}  // namespace isotherm
