#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "common/base/status.h"
#include "common/rig/rig.h"

namespace isotherm {

class CameraIntrinsics;
class DepthSensorProperties;
class RigCalibration;
class ThermalSensorProperties;
class Transform;

/// rig.textproto, checked (Validate) and converted. Messages name the file and the field.
Result<Rig> LoadRigCalibration(const std::filesystem::path& path);
Result<Rig> ParseRigCalibration(const std::string& text, std::string_view source_name);
std::string ToText(const Rig& rig);

/// Conversions between the rig file's proto (RigCalibration) and the stages' types. No checks:
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
