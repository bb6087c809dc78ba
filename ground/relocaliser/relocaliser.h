#pragma once

#include <optional>

#include "common/concurrency/thread_pool.h"
#include "ground/icp/icp_tracker.h"
#include "ground/options/ground_options.pb.h"
#include "ground/relocaliser/keyframe_database.h"
#include "ground/surface/depth_preprocessor.h"
#include "ground/tsdf/raycaster.h"
#include "ground/tsdf/tsdf_volume.h"

namespace isotherm {

Status Validate(const RelocaliserOptions& options);

/// Finds the camera in a model after tracking was lost: guesses from the views that were tracked,
/// each refined against the model at low resolution. What it finds is a candidate, for the tracker
/// to assess at full resolution. Thread-compatible.
class Relocaliser {
 public:
  Relocaliser(const RelocaliserOptions& options, const CameraModel& depth_camera);

  /// A pose that was tracked well, and fused: the model has changed since it was looked through.
  void Add(const RigidTransform& T_map_depth) {
    keyframes_.Add(T_map_depth);
    knows_model_ = false;
  }

  /// The pose that explains the frame best, if one explains enough of it. One call takes a few
  /// milliseconds and looks around some of the known views; the next call goes on with others. The
  /// first call after the model has changed also goes through all of it: some ten milliseconds.
  std::optional<RigidTransform> Find(const PreparedDepth& depth, const TsdfVolume& volume,
                                     float min_weight, ThreadPool& pool);

  const KeyframeDatabase& keyframes() const { return keyframes_; }

 private:
  class Refinement;

  const RelocaliserOptions options_;
  const CameraModel camera_;
  KeyframeDatabase keyframes_;
  bool knows_model_ = false;  ///< The keyframe database has a cloud of the model as it is.
  Raycaster raycaster_;
  ModelView view_;
};

}  // namespace isotherm
