#pragma once

#include <cstdint>
#include <vector>

#include "common/concurrency/thread_pool.h"
#include "common/frame/frame.h"
#include "common/geometry/camera.h"
#include "ground/ground_options.pb.h"
#include "ground/thermal/thermal_volume.h"
#include "ground/tracker/surface_maps.h"
#include "ground/tsdf/tsdf_volume.h"

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
bool ReplacesMeasurement(ConditionClass new_distance, ConditionClass new_angle, ThermalVoxel old);

/// Removes lens distortion from thermal frames: °C per pixel of the ideal camera, NaN outside the
/// picture or where the frame has no value. Bilinear. Thread-compatible.
class ThermalRectifier {
 public:
  explicit ThermalRectifier(const CameraModel& camera);
  void Rectify(const Image<std::uint16_t>& centikelvin, ThreadPool& pool,
               Image<float>& celsius) const;
  const CameraModel& ideal_camera() const { return ideal_; }

 private:
  CameraModel ideal_;
  Image<float> source_x_, source_y_;  ///< Where each rectified pixel comes from, pixels.
};

/// What one thermal frame did to the model.
struct FusionReport {
  std::int64_t considered = 0;  ///< Voxels on the surface in view of both cameras.
  std::int64_t occluded =
      0;  ///< Of these: hidden from the thermal camera or too near an occluding edge.
  std::int64_t assigned = 0;
};

/// Assigns temperatures to the surface that both cameras see (algorithms 4 to 6). Keeps scratch
/// images. Thread-compatible.
class ThermalFuser {
 public:
  ThermalFuser(const ThermalOptions& options, const CameraModel& thermal_camera);

  /// `view`: the model in `world` as the depth camera sees it from `T_world_depth`.
  /// `T_world_thermal` is the thermal camera's pose when `frame` was captured. `frame` must be
  /// valid and have the camera's size (CHECK).
  FusionReport Fuse(const ThermalFrame& frame, const RigidTransform& T_world_thermal,
                    const SurfaceMaps& view, const CameraModel& view_camera,
                    const RigidTransform& T_world_depth, const TsdfVolume& tsdf, ThreadPool& pool,
                    ThermalVolume& thermal);

 private:
  void MakeDistanceMap(const SurfaceMaps& view, const RigidTransform& T_thermal_world);
  void SelectBlocks(const SurfaceMaps& view, const TsdfVolume& tsdf);
  void SampleVertices(const SurfaceMaps& view, const RigidTransform& T_thermal_world,
                      const Eigen::Vector3f& thermal_position, ThreadPool& pool);

  const ThermalOptions options_;
  const ConditionLimits limits_;
  const ThermalRectifier rectifier_;
  Image<float> celsius_;
  Image<float> nearest_m_;  ///< Algorithm 4's D: distance to the nearest vertex per thermal pixel.
  Image<float> nearest_around_m_;             ///< The same, smallest within the edge margin.
  std::vector<float> vertex_celsius_;         ///< Per view pixel, NaN = not to be assigned.
  std::vector<std::uint8_t> vertex_classes_;  ///< Distance class << 4 | angle class.
  std::vector<std::int32_t> blocks_;
  std::vector<std::uint32_t> block_stamp_;
  std::uint32_t stamp_ = 0;
  std::int64_t occluded_ = 0;
};

}  // namespace isotherm
