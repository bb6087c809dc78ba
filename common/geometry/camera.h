#pragma once

#include <Eigen/Core>
#include <limits>
#include <optional>

#include "common/base/status.h"
#include "common/geometry/radiometric_scale.h"
#include "common/geometry/rigid_transform.h"

namespace isotherm {

/// Pinhole camera with OpenCV's five-parameter distortion (same order and meaning). Pixel centres
/// are at integer coordinates: pixel (u, v) covers [u - 0.5, u + 0.5). Coordinate frame: optical (x
/// right, y down, z forward). Thermal and depth cameras use the same model (thesis 2.3.5).
struct CameraModel {
  int width = 0;
  int height = 0;
  double fx = std::numeric_limits<double>::quiet_NaN();
  double fy = std::numeric_limits<double>::quiet_NaN();
  double cx = std::numeric_limits<double>::quiet_NaN();
  double cy = std::numeric_limits<double>::quiet_NaN();
  double k1 = 0.0, k2 = 0.0, p1 = 0.0, p2 = 0.0, k3 = 0.0;

  bool HasDistortion() const {
    return k1 != 0.0 || k2 != 0.0 || p1 != 0.0 || p2 != 0.0 || k3 != 0.0;
  }
  /// The same camera without lens distortion (what a rectified image has).
  CameraModel WithoutDistortion() const;
  /// The camera of an image halved `levels` times by 2x2 averaging; sizes round down.
  CameraModel Downscaled(int levels) const;
};

/// Checks sizes (1..16384), finite and positive focal lengths, a principal point inside the image,
/// and finite distortion. `name` is the camera's field in the rig file, for the message.
Status Validate(const CameraModel& intrinsics, std::string_view name);

/// Normalised image coordinates (x/z, y/z) -> distorted pixel coordinates.
Eigen::Vector2d ProjectNormalized(const CameraModel& camera, const Eigen::Vector2d& normalized);

/// Point in the camera's optical frame (metres) -> distorted pixel coordinates; nullopt behind the
/// camera.
std::optional<Eigen::Vector2d> Project(const CameraModel& camera, const Eigen::Vector3d& p_camera);

/// Pixel coordinates (distorted) -> normalised image coordinates without distortion, by fixed-point
/// iteration.
Eigen::Vector2d Unproject(const CameraModel& camera, const Eigen::Vector2d& pixel);

/// Says what a depth camera can see. The defaults are those of a PrimeSense-like camera.
struct DepthSensorModel {
  /// It sees nothing closer, so something there may hide surfaces unnoticed; 0 = nothing is there.
  double near_range_m = 0.35;
  double min_depth_m = 0.3, max_depth_m = 4.0;  ///< Depth outside is no return.
  double noise_at_1m_m = 0.006;  ///< Noise and unevenness; it grows with the square of the depth.
};

/// Describes a lens set to one distance.
struct LensModel {
  double focal_length_m = 0.0;
  double f_number = 0.0;
  double focus_m = 0.0;  ///< Distance of what is sharp.
};

/// Says how a thermal camera takes its images. The defaults are those of a microbolometer whose
/// lens is not known.
struct ThermalSensorModel {
  double time_constant_s = 0.010;  ///< A pixel follows a change of temperature with it.
  double row_readout_s = 0.0;      ///< From one row to the next; 0 = all at once.
  std::optional<double> pixel_pitch_m;
  std::optional<LensModel> lens;
};

/// Holds what is known about one rig: its calibration, and what belongs to its cameras. Data, not
/// configuration.
struct Rig {
  std::optional<CameraModel> depth;
  std::optional<CameraModel> thermal;
  double depth_scale = 1000.0;  ///< Raw depth units per metre.
  RadiometricScale thermal_scale{};
  /// Maps depth-camera coordinates to thermal-camera coordinates. Absent: thermal cannot be fused.
  std::optional<RigidTransform> T_thermal_depth;
  double thermal_delay_s = 0.0;  ///< Added to thermal timestamps.
  std::string serial, date, method;
  std::string depth_serial, thermal_serial;  ///< The cameras that were calibrated; empty = any.
  std::optional<double> reprojection_error_px;
  DepthSensorModel depth_sensor;
  ThermalSensorModel thermal_sensor;
};

/// The message names the field of the rig file.
Status Validate(const DepthSensorModel& sensor);
Status Validate(const ThermalSensorModel& sensor);

/// Checks all that is present (ranges, finite, rigid); absent parts are allowed here and refused by
/// the stage that needs them.
Status Validate(const Rig& rig);

/// Says why thermal frames cannot be fused with this rig (one sentence), or ok.
Status CheckThermalFusion(const Rig& rig);

}  // namespace isotherm
