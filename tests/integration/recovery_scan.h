#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "common/geometry/camera.h"
#include "common/geometry/rigid_transform.h"
#include "common/rig/rig.h"
#include "common/simulation/depth_sensor.h"
#include "common/simulation/scenes.h"
#include "ground/pipeline/ground_pipeline.h"

namespace isotherm::testing {

/// A scan of an analytic scene with the noise of a real depth camera, frame by frame, with the true
/// pose of each frame at hand.
class RecoveryScan {
 public:
  /// `seed` decides all noise. At half of the depth camera's size and 4 mm voxels, for speed.
  RecoveryScan(Scene scene, std::uint64_t seed);

  GroundOptions& options() { return options_; }
  /// Starts (again) with an empty model.
  void Start(const RigidTransform& first_pose);
  /// Shows the pipeline what the camera sees from `pose`, 1/30 s after the frame before.
  DepthReport Show(const RigidTransform& pose);
  /// The same with something before the camera.
  DepthReport ShowCovered();
  DepthFrame Render(const RigidTransform& pose);

  /// Capture time of the next frame that is shown.
  CaptureTime next_time() const;

  GroundPipeline& pipeline() { return *pipeline_; }
  const CameraModel& camera() const { return *rig_.depth; }
  /// Distance between the newest pose of the trajectory and `truth`, metres.
  double PositionError(const RigidTransform& truth) const;

  /// Depth of the model against the scene's from some poses: median and 95th percentile of the
  /// absolute difference, metres, and the fraction of the scene's pixels that the model has.
  struct ModelError {
    double median_m = 0.0;
    double p95_m = 0.0;
    double covered = 0.0;
  };
  ModelError CompareModel(const std::vector<RigidTransform>& poses) const;

 private:
  const Scene scene_;
  const std::uint64_t seed_;
  Rig rig_;
  GroundOptions options_;
  std::unique_ptr<DepthSensor> sensor_;
  DepthSensor::Scratch scratch_;
  std::unique_ptr<GroundPipeline> pipeline_;
  std::uint64_t frame_ = 0;
};

}  // namespace isotherm::testing
