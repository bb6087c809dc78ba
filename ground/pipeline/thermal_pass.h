#pragma once

#include <vector>

#include "common/concurrency/thread_pool.h"
#include "common/doubts/repeat_detector.h"
#include "common/frame/frame.h"
#include "common/geometry/rigid_transform.h"
#include "common/rig/rig.h"
#include "ground/icp/motion_history.h"
#include "ground/options/ground_options.pb.h"
#include "ground/pipeline/thermal_stage.h"
#include "ground/surface/depth_preprocessor.h"
#include "ground/tsdf/view_raycaster.h"

namespace isotherm {

/// Holds where the rig was at a depth frame, and how certain that was.
struct PassPose {
  CaptureTime time;
  RigidTransform T_map_depth;
  double surface_sigma_rad = 0.0;  ///< As in TrackedDepth.
  double mean_depth_m = 1.0;       ///< As in TrackedDepth.
};

/// Holds what a pass works on; all of it must outlive the pass.
struct PassModel {
  const TsdfVolume& tsdf;
  ThermalVolume& thermal;
  ThermalStage& stage;
  ScanCounts& counts;
  ThreadPool& pool;
};

/// Assigns the temperatures of a scan to its finished surface. The scan's frames come again, in the
/// same order, and each thermal frame is fused at the pose that is known by now. While a scan goes
/// on, what is scanned later can neither take a temperature nor hide what lies behind it, and
/// surface that the depth camera does not see at the time is left alone, for something unscanned
/// may be before it. At the end, whatever was ever scanned is known. Thread-bound.
class ThermalPass {
 public:
  /// `poses` are those of the tracked depth frames in the coordinates of `model.tsdf`, in order of
  /// time. `model.thermal` has no temperatures yet, and `model.stage` has seen no frames.
  ThermalPass(const GroundOptions& options, const Rig& rig, std::vector<PassPose> poses,
              const PassModel& model);

  void ProcessDepth(const DepthFrame& frame);
  void ProcessThermal(ThermalFramePtr frame);
  /// Counts the thermal frames that still wait, and reviews all temperatures.
  void Finish();

 private:
  /// Returns nullptr for a frame that was not tracked.
  const PassPose* FindPose(CaptureTime time) const;
  void FuseUpTo(const DepthFrame& frame, const PassPose& pose);

  const std::vector<PassPose> poses_;
  const PassModel model_;
  DepthPreprocessor preprocessor_;
  ViewRaycaster raycaster_;
  ModelView view_;
  MotionHistory motion_;  ///< Cleared where tracking was lost.
  RepeatDetector repeats_;
};

}  // namespace isotherm
