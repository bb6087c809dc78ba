#pragma once

#include <cstdint>
#include <span>

#include "common/frame/image.h"
#include "common/geometry/camera.h"
#include "common/geometry/rigid_transform.h"
#include "common/rig/sensor_models.h"
#include "ground/options/ground_options.pb.h"
#include "ground/surface/surface_maps.h"
#include "ground/thermal/thermal_kernel.h"

namespace isotherm {

/// Leaves out thermal pixels whose line of sight may be occluded. An occluder need not be in the
/// model: it may be a face that the depth camera sees only edge-on, or a part of a thing that is
/// outside its image. So a thermal pixel is assigned only if no part of its line of sight, from the
/// near range to the surface, lies behind what the depth camera sees of the model (as in space
/// carving, Kutulakos and Seitz 2000). A thing that reaches its image's border is taken to go on
/// beyond. Thread-compatible.
class LineOfSightOcclusion {
 public:
  /// `thermal_camera` without distortion.
  LineOfSightOcclusion(const ThermalOcclusionOptions& options, const DepthSensorModel& depth_sensor,
                       const CameraModel& thermal_camera);

  /// `model`: the model's surface in `map` as seen by the depth camera (`model_camera`, perhaps
  /// halved) from `T_map_depth`.
  void Update(const SurfaceMaps& model, const CameraModel& model_camera,
              const RigidTransform& T_map_depth);

  /// Where the thermal camera was when the frame to be assessed was captured, seen from the depth
  /// camera of the last Update. Both move while they wait for each other.
  void Aim(const RigidTransform& T_depth_thermal);

  /// Makes pixels of rows y to y + rows.size() / width - 1 unassignable that the depth camera does
  /// not prove to be seen. Returns how many were assignable. Thread-safe.
  std::int64_t LeaveOut(int y, std::span<ThermalPixel> rows) const;

 private:
  /// First depth along the thermal camera's z, beginning at the near range, at which the line of
  /// sight is hidden from the depth camera; `z_m` if it is nowhere before that.
  float ProvenUpTo(const Eigen::Vector2f& xy_thermal, float z_m) const;

  const float near_range_m_;  ///< 0 = everything is believed.
  const float tolerance_m_;
  const CameraModel thermal_camera_;
  Eigen::Matrix3f R_depth_thermal_ = Eigen::Matrix3f::Identity();
  Eigen::Vector3f t_depth_thermal_ = Eigen::Vector3f::Zero();
  /// Depth of the model along the depth camera's z, at every second pixel; NaN = none.
  Image<float> depth_m_;
  float fx_ = 0.0F, fy_ = 0.0F, cx_ = 0.0F, cy_ = 0.0F;  // In pixels of depth_m_.
};

}  // namespace isotherm
