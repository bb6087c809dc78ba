#pragma once

#include <cstdint>
#include <optional>

#include "common/concurrency/thread_pool.h"
#include "ground/ground_options.pb.h"
#include "ground/relocaliser/relocaliser.h"
#include "ground/tracker/icp_tracker.h"
#include "ground/tracker/motion_history.h"
#include "ground/tracker/pose_uncertainty.h"
#include "ground/tsdf/raycaster.h"
#include "ground/tsdf/tsdf_volume.h"

namespace isotherm {

/// Where the rig is, frame by frame: follows it against the model, says when it is lost, and looks
/// for it until it is found again. Never changes the model.
/// Thread-bound.
class RigTracker {
 public:
  enum class State : std::uint8_t {
    kFollowing,
    kLost,
    kConfirming,  ///< Found again; nothing may be fused until some more frames agree.
  };

  RigTracker(const GroundOptions& options, const CameraModel& depth_camera);

  /// The first frame's pose is given, and nothing is tracked against yet.
  TrackingResult Begin(const PreparedDepth& depth, CaptureTime time, const RigidTransform& pose);
  /// The scan goes on in a model that is there already, from anywhere near a known view.
  void BeginLost() { state_ = State::kLost; }

  /// The pose of the next frame against `volume`.
  TrackingResult Track(const PreparedDepth& depth, CaptureTime time, const TsdfVolume& volume,
                       ThreadPool& pool);

  /// After each tracked frame, with what it changed: the model from its pose, to track against.
  /// `is_young`: the model is little more than one frame's noise.
  void LookFrom(const RigidTransform& T_world_depth, const TsdfVolume& volume, bool is_young,
                ThreadPool& pool);
  /// The first frame's pose was of no use: as before it.
  void Forget();
  /// Of a frame that was fused: a view to come back to.
  void Remember(const RigidTransform& T_world_depth);

  State state() const { return state_; }
  /// Times that the rig was found again.
  std::uint64_t relocalisations() const { return relocalisations_; }
  const ModelView& view() const { return view_; }
  const MotionHistory& motion() const { return motion_; }
  const PoseUncertainty& uncertainty() const { return uncertainty_; }
  const Relocaliser& relocaliser() const { return relocaliser_; }

 private:
  /// What frames usually look like: a frame that differs is not on the right surface.
  struct Usual {
    double residual_per_m = 0.0;  ///< Over the square of the depth.
    double agreement = 0.0;
    int frames = 0;
  };

  IcpTracker::Start Predict(CaptureTime time) const;
  /// Unlike the frames before, although within all limits.
  LostReason FindAnomaly(const TrackingResult& result) const;
  /// Good enough to believe after having been lost.
  bool IsConvincing(const TrackingResult& result) const;
  TrackingResult LookAround(const PreparedDepth& depth, const TsdfVolume& volume, ThreadPool& pool);
  /// The largest residual in metres that is this many times the usual one at most.
  double ResidualLimit(const TrackingResult& result, double times_usual) const;
  /// The frame is where it seems to be: learns from it.
  void Trust(const TrackingResult& result, CaptureTime time);
  void CastView(const RigidTransform& T_world_depth, const TsdfVolume& volume, ThreadPool& pool,
                ModelView& view);

  const TrackerOptions options_;
  const RelocaliserOptions relocaliser_options_;
  const float min_weight_;
  IcpTracker tracker_;
  Relocaliser relocaliser_;
  Raycaster raycaster_;
  ModelView view_;
  ModelView candidate_;  ///< The model from a pose where the rig may be.
  MotionHistory motion_;
  PoseUncertainty uncertainty_;
  Usual usual_;
  State state_ = State::kFollowing;
  int to_confirm_ = 0;
  RigidTransform trusted_pose_ = RigidTransform::Identity();  ///< The last one while following.
  CaptureTime trusted_time_;
  bool has_trusted_pose_ = false;
  bool speed_is_known_ = false;  ///< Two frames in a row were fully observed since the last loss.
  int lost_frames_ = 0;          ///< They take turns: back at the last view once, then all around.
  bool knows_model_ = false;     ///< The relocaliser does, as it is since tracking was lost.
  std::uint64_t relocalisations_ = 0;
};

}  // namespace isotherm
