#pragma once

#include <cstdint>
#include <memory>
#include <optional>

#include "common/concurrency/thread_pool.h"
#include "common/frame/frame.h"
#include "ground/atlas/sub_map.h"
#include "ground/icp/icp_tracker.h"
#include "ground/icp/motion_history.h"
#include "ground/icp/odometry_prior.h"
#include "ground/icp/pose_uncertainty.h"
#include "ground/options/ground_options.pb.h"
#include "ground/tsdf/tsdf_volume.h"
#include "ground/tsdf/view_raycaster.h"

namespace isotherm {

/// Knows where the rig is, frame by frame: follows it against a sub-map, says when it is lost, and
/// looks for it until it is found again. All poses are in the coordinates of the sub-map that is
/// tracked against. Never changes a sub-map's surface. Thread-bound.
class RigTracker {
 public:
  /// Says whether frames are tracked against the model.
  enum class State : std::uint8_t {
    kFollowing,
    kLost,
    kConfirming,  ///< Found again; nothing may be fused until some more frames agree.
  };

  RigTracker(const GroundOptions& options, const CameraModel& depth_camera);
  ~RigTracker();
  /// From now on, temperatures help where the geometry does not suffice.
  void UseThermal(const CameraModel& thermal_camera, const RigidTransform& T_thermal_depth);
  /// A valid thermal frame of the camera's size, before the first depth frame after it.
  void AddThermal(ThermalFramePtr frame);

  /// Takes what a source says about the rig's motion, in order of capture time, ideally
  /// before the first depth frame that is not older.
  void AddExternalOdometry(const ExternalOdometry& pose) { odometry_.Add(pose); }

  /// The first frame of a sub-map: its pose is given, and nothing is tracked against yet.
  TrackingResult Begin(const PreparedDepth& depth, CaptureTime time, const RigidTransform& pose);
  /// The scan goes on in a model that is there already, from anywhere near a known view.
  void BeginLost() { state_ = State::kLost; }

  /// The pose of the next frame against `here`. While lost, the rig is also looked for in
  /// `searched`, which may be the same; then found_elsewhere() tells whether it was there.
  TrackingResult Track(const PreparedDepth& depth, CaptureTime time, const SubMap& here,
                       const SubMap& searched, ThreadPool& pool);
  /// The last frame was found in `searched`: its pose is in those coordinates, and so must be all
  /// that comes.
  bool found_elsewhere() const { return found_elsewhere_; }
  /// Goes on in another sub-map's coordinates. LookFrom must follow.
  void Rebase(const RigidTransform& T_new_old);

  /// Tracks a frame against a sub-map near `T_map_depth`; the result is lost unless the frame fits
  /// as well as frames usually do. Changes nothing.
  TrackingResult Verify(const PreparedDepth& depth, const RigidTransform& T_map_depth,
                        const SubMap& map, ThreadPool& pool);

  /// After each tracked frame, with what it changed: the model from its pose, to track against.
  /// `is_young`: the model is little more than one frame's noise.
  void LookFrom(const RigidTransform& T_map_depth, const TsdfVolume& volume, bool is_young,
                ThreadPool& pool);
  /// The first frame's pose was of no use: as before it.
  void Forget();

  State state() const { return state_; }
  /// Times that the rig was found again.
  std::uint64_t relocalisations() const { return relocalisations_; }
  const ModelView& view() const { return view_; }
  const MotionHistory& motion() const { return motion_; }
  const PoseUncertainty& uncertainty() const { return uncertainty_; }
  /// Returns whether the speed was ever measured in all directions since the scan began, or since
  /// the rig was lost.
  bool is_speed_known() const { return speed_is_known_; }
  /// Returns whether the last frame started where odometry with positions had it, which holds what
  /// the view does not.
  bool is_held_by_odometry() const { return is_position_given_; }
  const OdometryPrior& external_odometry() const { return odometry_; }

 private:
  /// Tells how frames usually look: one that differs is not on the right surface.
  struct Usual {
    double residual_per_m = 0.0;  ///< Over the square of the depth.
    double agreement = 0.0;
    int frames = 0;
  };

  IcpTracker::Start Predict(CaptureTime time) const;
  /// Tracks the frame after one that was tracked: from where a source says that the rig is,
  /// or else, and if that does not fit, from constant velocity.
  TrackingResult Follow(const PreparedDepth& depth, CaptureTime time, const TsdfVolume& volume,
                        ThreadPool& pool);
  /// The error of constant velocity since the last trusted frame.
  PriorError InertialError(CaptureTime time, double mean_depth_m) const;
  /// Unlike the frames before, although within all limits.
  LostReason FindAnomaly(const TrackingResult& result) const;
  /// Good enough to believe after having been lost.
  bool IsConvincing(const TrackingResult& result) const;
  TrackingResult LookAround(const PreparedDepth& depth, const SubMap& here, const SubMap& searched,
                            ThreadPool& pool);
  /// The largest residual in metres that is this many times the usual one at most.
  double ResidualLimit(const TrackingResult& result, double times_usual) const;
  /// The frame is where it seems to be: learns from it.
  void Trust(const TrackingResult& result, CaptureTime time);
  void CastView(const RigidTransform& T_map_depth, const TsdfVolume& volume, ThreadPool& pool,
                ModelView& view);

  const TrackerOptions options_;
  const RelocaliserOptions relocaliser_options_;
  const float min_weight_;
  IcpTracker tracker_;
  std::unique_ptr<ThermalAlignment> alignment_;
  ViewRaycaster raycaster_;
  ModelView view_;
  ModelView candidate_;  ///< The model from a pose where the rig may be.
  MotionHistory motion_;
  OdometryPrior odometry_;
  std::optional<PriorError> odometry_error_;  ///< If the newest frame started from odometry poses.
  bool is_position_given_ = false;            ///< By them, too.
  PoseUncertainty uncertainty_;
  Usual usual_;
  State state_ = State::kFollowing;
  int to_confirm_ = 0;
  RigidTransform trusted_pose_ = RigidTransform::Identity();  ///< The last one while following.
  CaptureTime trusted_time_;
  bool has_trusted_pose_ = false;
  bool speed_is_known_ = false;  ///< Two frames in a row were fully observed since the last loss.
  int lost_frames_ = 0;          ///< They take turns: back at the last view once, then all around.
  bool found_elsewhere_ = false;
  std::uint64_t relocalisations_ = 0;
};

}  // namespace isotherm
