#pragma once

#include <cstdint>
#include <deque>
#include <optional>

#include "common/base/stage_stats.h"
#include "common/concurrency/thread_pool.h"
#include "common/frame/frame.h"
#include "common/geometry/camera.h"
#include "common/geometry/map_pose.h"
#include "common/geometry/rigid_transform.h"
#include "common/rig/rig.h"
#include "ground/icp/icp_tracker.h"
#include "ground/scan/scan_counts.h"
#include "ground/thermal/line_of_sight_occlusion.h"
#include "ground/thermal/near_range_occlusion.h"
#include "ground/thermal/nuc_epochs.h"
#include "ground/thermal/thermal_fuser.h"
#include "ground/thermal/uncertainty_budget.h"
#include "ground/tsdf/block_versions.h"

namespace isotherm {

/// Says which thermal frames are left out for lack of time ("behind").
enum class ThermalThinning : std::uint8_t {
  kNone,
  kEverySecond,
  /// All that follow one that is fused within kSparseInterval. Some stay however little time there
  /// is: surface that is passed meanwhile would have no temperature at all.
  kSparse,
  kScarce,  ///< The same within kScarceInterval.
};

/// The rig at a tracked depth frame, in the coordinates of `tsdf`.
struct TrackedDepth {
  const Image<float>& depth_m;            ///< The frame itself; 0 = no return.
  const ModelView& view;                  ///< The model from its pose.
  std::optional<StampedMapPose> earlier;  ///< Two frames before; nullopt = not known.
  std::optional<StampedMapPose> before;   ///< One frame before; nullopt = not known.
  StampedMapPose now;
  double surface_sigma_rad = 0.0;  ///< One standard deviation of the pose, as a shift of surface
                                   ///< over its mean depth.
  double mean_depth_m = 1.0;       ///< Depth of the surface in view.
  const TsdfVolume& tsdf;
  /// Says why thermal frames cannot be fused now at all, if so.
  std::optional<LeftOutReason> refusal = std::nullopt;
  ThermalThinning thinning = ThermalThinning::kNone;
  bool is_finished = false;           ///< CaptureConditions::surface_is_finished.
  BlockVersions* versions = nullptr;  ///< Hears which blocks got temperatures.
};

/// Returns whether a frame comes from a camera that measures no temperatures
/// (Encoding::kCounts16).
inline bool IsCountsOnly(const ThermalFrame& frame) {
  return frame.temperature_raw.empty() && !frame.valid;
}

/// Takes thermal frames from their arrival to the model: each waits for the depth frame behind it,
/// since its pose lies between those of two depth frames (6.2.3). What the rig did between them is
/// not known: the pose is as uncertain as the rig could accelerate, and the motion is the fastest
/// that the poses around tell. Thread-bound.
class ThermalStage {
 public:
  /// CheckThermalFusion(rig) is ok. Voxels lighter than `min_weight` do not count as observed.
  /// `counts` must outlive the stage.
  ThermalStage(const ThermalOptions& options, const Rig& rig, float min_weight, ScanCounts& counts);

  /// Keeps a frame, or counts why not. Frames come in order of capture time. True if it was kept.
  bool Add(ThermalFramePtr frame);
  /// Returns whether FuseUpTo has anything to do at this time.
  bool HasFramesUpTo(CaptureTime time) const {
    return !waiting_.empty() && waiting_.front().frame->header.capture_time <= time;
  }
  /// Fuses, or counts as left out, what was captured up to `depth.now`.
  void FuseUpTo(const TrackedDepth& depth, ThermalVolume& thermal, ThreadPool& pool);
  /// Counts what still waits as left out, and reviews all temperatures.
  void Finish(const TsdfVolume& tsdf, ThermalVolume& thermal, ThreadPool& pool);

  /// Returns the times of the frames that were fused.
  const StageStats& times() const { return times_; }

 private:
  /// Holds a frame until the depth frames on both sides of it are tracked.
  struct Waiting {
    ThermalFramePtr frame;
    NucAge nuc;
  };

  /// One standard deviation of the pose at `time`, in the thermal image.
  double RegistrationSigmaPx(CaptureTime time, const TrackedDepth& depth) const;
  /// Motion of the thermal camera between the two depth frames.
  CameraMotion MotionAround(const TrackedDepth& depth) const;
  /// Says which frame is next to go, so it is asked once for each frame.
  bool IsThinnedOut(ThermalThinning thinning, CaptureTime time);
  /// nullopt: the frame can be fused.
  std::optional<LeftOutReason> WhyLeftOut(CaptureTime time, const TrackedDepth& depth) const;
  void Fuse(const Waiting& waiting, const TrackedDepth& depth, ThermalVolume& thermal,
            ThreadPool& pool);
  void LeaveOut(LeftOutReason reason) { ++counts_.thermal_left_out[reason]; }
  void LeaveOut(LeftOutReason reason, CaptureTime time) {
    LeaveOut(reason);
    last_unusable_ = time;
  }
  /// To be called when a frame is fused.
  void NotePause(CaptureTime time);

  const ThermalOptions options_;
  const CameraModel camera_;
  const RigidTransform T_depth_thermal_;
  const double extrinsic_px_;
  const CameraUncertainty uncertainty_;
  ScanCounts& counts_;
  StageStats times_;
  ThermalFuser fuser_;
  NearRangeOcclusion near_range_occlusion_;
  LineOfSightOcclusion line_of_sight_occlusion_;
  NucEpochs nuc_epochs_;
  std::deque<Waiting> waiting_;
  bool skip_next_ = false;  ///< With ThermalThinning::kEverySecond.
  std::optional<CaptureTime> last_fused_;
  bool was_thinned_ = false;                  ///< Since then.
  std::optional<CaptureTime> last_unusable_;  ///< Left out for another reason.
};

}  // namespace isotherm
