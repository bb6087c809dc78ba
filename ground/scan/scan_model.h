#pragma once

#include "common/base/status.h"
#include "common/concurrency/thread_pool.h"
#include "common/rig/rig.h"
#include "ground/atlas/atlas.h"
#include "ground/icp/icp_tracker.h"
#include "ground/icp/motion_history.h"
#include "ground/icp/odometry_prior.h"
#include "ground/icp/pose_uncertainty.h"
#include "ground/model/block_spiller.h"
#include "ground/scan/scan_counts.h"
#include "ground/scan/stage_times.h"
#include "ground/tracker/trajectory.h"

namespace isotherm {

/// Shows what a scan has given so far, to be read between two frames: the model, where the rig was,
/// and what became of the frames. It refers to what the pipeline goes on with, so it is valid as
/// long as the pipeline is. Thread-bound, with the pipeline.
struct ScanModel {
  const Rig& rig;
  const Atlas& atlas;
  const Trajectory& trajectory;
  const ModelView& view;  ///< The model from the last pose; empty maps before the first frame.
  const MotionHistory& motion;         ///< The last poses, in the active sub-map.
  const PoseUncertainty& uncertainty;  ///< How uncertain the last tracked pose is.
  const OdometryPrior& external_odometry;
  const ScanCounts& counts;
  const StageTimes stages;
  const BlockSpiller& spiller;
  const Status& thermal_status;  ///< Why thermal frames are not fused at all, or ok.
  const bool is_continued;       ///< The scan goes on with a saved model.
  ThreadPool& pool;              ///< The pipeline's threads, lent for work between two frames.

  /// The volume of the active sub-map, in its coordinates; after Finish the whole model, in
  /// `world`.
  const TsdfVolume& tsdf() const { return *atlas.active().tsdf; }
  const ThermalVolume& thermal() const { return *atlas.active().thermal; }
};

/// The model from the last pose, at the depth camera's full resolution. Voxels lighter than
/// `min_weight` do not count as observed.
SurfaceMaps CastFullView(const ScanModel& model, double min_weight);

}  // namespace isotherm
