#pragma once

#include <deque>
#include <memory>

#include "common/concurrency/thread_pool.h"
#include "common/frame/frame.h"
#include "common/geometry/camera.h"
#include "ground/pipeline/scan_model.h"
#include "ground/surface/surface_maps.h"
#include "ground/thermal/measurement_conditions.h"
#include "ground/thermal/thermal_rectifier.h"
#include "ground/thermal/thermal_volume.h"
#include "ground/tsdf/raycaster.h"

namespace isotherm {

/// Which vertices of the depth camera's view are not given a temperature.
enum class ParallaxFilter {
  kNone,
  kAlgorithm4,  ///< Those behind another vertex that falls on the same thermal pixel.
};

/// The thesis's own assignment of temperatures, literally and slowly, to compare with: the model is
/// cast from the depth camera's pose, filtered (algorithm 4) and each voxel takes the temperature
/// of its vertex (algorithms 5 and 6). Thread-compatible.
class ThesisFuser {
 public:
  /// Voxels lighter than `min_weight` do not count as observed.
  ThesisFuser(const ThermalOptions& options, const Rig& rig, float min_weight,
              ParallaxFilter filter);

  void Fuse(const ThermalFrame& frame, const RigidTransform& T_world_thermal,
            const RigidTransform& T_world_depth, const TsdfVolume& tsdf, ThreadPool& pool,
            ThermalVolume& thermal);

 private:
  /// A vertex of the depth camera's view and what is measured there.
  struct Vertex {
    Eigen::Vector3f p_world = Eigen::Vector3f::Zero();
    float celsius = 0.0F;  ///< NaN = gets no temperature.
    ConditionClass distance = ConditionClass::kBad;
    ConditionClass angle = ConditionClass::kBad;
  };
  void FindVertices(const RigidTransform& T_world_thermal, ThreadPool& pool);
  Vertex Measure(const Eigen::Vector3f& p_world, const Eigen::Vector3f& n_world,
                 const RigidTransform& T_world_thermal) const;
  void UpdateBlock(std::int32_t block, const RigidTransform& T_depth_world, const TsdfVolume& tsdf,
                   ThermalVolume& thermal) const;

  const ThermalOptions options_;
  const ConditionLimits limits_;
  const CameraModel depth_camera_;
  const float min_weight_;
  const ParallaxFilter filter_;
  ThermalRectifier rectifier_;
  Raycaster raycaster_;
  SurfaceMaps maps_;
  Image<float> celsius_;    ///< The rectified thermal image.
  Image<float> nearest_m_;  ///< Per thermal pixel, distance of the nearest vertex.
  Image<Vertex> vertices_;  ///< Per depth pixel.
};

/// Follows a pipeline: gives the same thermal frames, at the same poses, to a thesis fuser with a
/// thermal volume of its own. Thread-compatible.
class ThesisFusion {
 public:
  ThesisFusion(const GroundOptions& options, const Rig& rig, const ScanModel& model,
               ParallaxFilter filter);

  void AddThermal(ThermalFramePtr frame) { waiting_.push_back(std::move(frame)); }
  /// After the pipeline has processed a depth frame.
  void AfterDepth(ThreadPool& pool);

  const ThermalVolume& thermal() const { return thermal_; }

 private:
  const Rig rig_;
  const ScanModel model_;
  ThesisFuser fuser_;
  ThermalVolume thermal_;
  std::deque<ThermalFramePtr> waiting_;
};

}  // namespace isotherm
