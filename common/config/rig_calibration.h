#pragma once

#include "common/geometry/camera.h"

namespace isotherm {

class CameraIntrinsics;
class DepthSensorProperties;
class RigCalibration;
class ThermalSensorProperties;
class Transform;

/// Conversions between the calibration message and the types that the stages use. No checks:
/// Validate(Rig) says whether the result makes sense; a quaternion of any length but zero is
/// normalised.
CameraModel FromProto(const CameraIntrinsics& intrinsics);
CameraIntrinsics ToProto(const CameraModel& camera);
RigidTransform FromProto(const Transform& transform);
Transform ToProto(const RigidTransform& transform);
DepthSensorModel FromProto(const DepthSensorProperties& sensor);
DepthSensorProperties ToProto(const DepthSensorModel& sensor);
ThermalSensorModel FromProto(const ThermalSensorProperties& sensor);
ThermalSensorProperties ToProto(const ThermalSensorModel& sensor);
Rig FromProto(const RigCalibration& calibration);
RigCalibration ToProto(const Rig& rig);

}  // namespace isotherm
