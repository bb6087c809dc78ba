#pragma once

#include <optional>
#include <string>

#include "common/base/status.h"
#include "common/frame/radiometric_scale.h"
#include "common/geometry/camera.h"
#include "common/geometry/rigid_transform.h"
#include "common/rig/sensor_models.h"

namespace isotherm {

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

/// Checks all that is present (ranges, finite, rigid); absent parts are allowed here and refused by
/// the stage that needs them.
Status Validate(const Rig& rig);

/// Says why thermal frames cannot be fused with this rig (one sentence), or ok.
Status CheckThermalFusion(const Rig& rig);

}  // namespace isotherm
