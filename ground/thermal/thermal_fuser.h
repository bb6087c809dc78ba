#pragma once

#include <cstdint>
#include <vector>

#include "common/concurrency/thread_pool.h"
#include "common/frame/frame.h"
#include "common/geometry/camera.h"
#include "ground/ground_options.pb.h"
#include "ground/thermal/thermal_kernel.h"
#include "ground/thermal/thermal_volume.h"
#include "ground/tracker/surface_maps.h"
#include "ground/tsdf/raycaster.h"
#include "ground/tsdf/tsdf_volume.h"
#include "ground/tsdf/visible_blocks.h"

namespace isotherm {

Status Validate(const ThermalOptions& options);

/// The distances and angles of (6.3a-b) in metres and as cosines, ready for inner loops.
struct ConditionLimits {
  float distance_min_m, distance_good_m, distance_max_m;
  float cosine_min_angle, cosine_good_angle, cosine_max_angle;

  explicit ConditionLimits(const ThermalOptions& options);
  ConditionClass ClassifyDistance(float distance_m) const;
  /// `cosine` of the emission angle, 0..1.
  ConditionClass ClassifyAngle(float cosine) const;
};

/// Algorithm 6: whether a measurement under the new classes replaces one under the old classes.
/// Under equal distance and angle classes the motion classes decide; a smeared measurement (kBad)
/// replaces nothing.
bool ReplacesMeasurement(ConditionClass new_distance, ConditionClass new_angle,
                         ConditionClass new_motion, ThermalVoxel old);

/// Removes lens distortion from thermal frames: °C per pixel of the ideal camera, NaN outside the
/// picture or where the frame has no value. Bilinear. Keeps scratch memory. Thread-compatible.
class ThermalRectifier {
 public:
  explicit ThermalRectifier(const CameraModel& camera);
  /// Writes into `celsius` with `apron` pixels of NaN all around.
  void Rectify(const Image<std::uint16_t>& centikelvin, int apron, ThreadPool& pool,
               Image<float>& celsius);
  const CameraModel& ideal_camera() const { return ideal_; }

 private:
  CameraModel ideal_;
  Image<std::int32_t> source_;  ///< Upper left of the four source pixels, -1 = outside.
  Image<float> fraction_x_, fraction_y_;
  Image<float> picture_;  ///< The frame in °C.
};

/// What one thermal frame did to the model.
struct FusionReport {
  std::int64_t considered = 0;  ///< Voxels on the surface that both cameras see.
  std::int64_t occluded = 0;    ///< Thermal pixels too near the edge of something nearer.
  std::int64_t assigned = 0;    ///< Voxels.
};

/// Assigns temperatures to the surface that both cameras see (algorithms 4 to 6). What the thermal
/// camera sees is decided by casting the model from its own pose, so that whatever was scanned
/// hides what lies behind it, whether or not the depth camera sees it now (beyond algorithm 4).
/// Keeps scratch images. Thread-compatible.
class ThermalFuser {
 public:
  /// Voxels lighter than `min_weight` do not count as observed.
  ThermalFuser(const ThermalOptions& options, const CameraModel& thermal_camera, float min_weight);

  /// `T_world_thermal` is the thermal camera's pose when `frame` was captured, `T_world_depth` that
  /// of the depth camera at about the same time. `frame` must be valid and have the camera's size
  /// (CHECK).
  FusionReport Fuse(const ThermalFrame& frame, const RigidTransform& T_world_thermal,
                    const CameraModel& depth_camera, const RigidTransform& T_world_depth,
                    const TsdfVolume& tsdf, ThreadPool& pool, ThermalVolume& thermal);

 private:
  /// What the thermal camera sees of the model, into surface_ and distances_m_.
  void CastSurface(const RigidTransform& T_world_thermal, const TsdfVolume& tsdf, ThreadPool& pool);
  std::int64_t MakePixels(const RigidTransform& T_world_thermal, const CameraModel& depth_camera,
                          const RigidTransform& T_world_depth, ThreadPool& pool);
  void SelectBlocks(const RigidTransform& T_world_thermal, const TsdfVolume& tsdf);

  const ThermalOptions options_;
  const ConditionLimits limits_;
  const float min_weight_;
  const int apron_;  ///< Pixels around distances_m_ and celsius_.
  ThermalRectifier rectifier_;
  Raycaster raycaster_{RaycastPrecision::kVisibility};
  SurfaceMaps coarse_;                   ///< Every second pixel each way.
  SurfaceMaps surface_;                  ///< The model as the thermal camera sees it, in world.
  Image<float> distances_m_;             ///< Of its vertices from the camera, with an apron.
  Image<float> celsius_;                 ///< With an apron.
  std::vector<ThermalPixel> pixels_;     ///< And one more that shows nothing.
  Image<float> nearest_m_, farthest_m_;  ///< Depth of the surface per tile; farthest 0 = none.
  VisibleBlocks visible_;
  std::vector<std::int32_t> blocks_;
};

}  // namespace isotherm
