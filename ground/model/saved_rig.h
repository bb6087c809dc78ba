#pragma once

#include <google/protobuf/repeated_field.h>

#include <optional>
#include <string>

#include "common/geometry/camera.h"
#include "common/geometry/rigid_transform.h"
#include "ground/model/model.pb.h"

namespace isotherm {

// Cameras and poses as the head of a model file has them.

inline constexpr int kPoseNumbers = 7;
/// Places further from the origin than this lose millimetres in the arithmetic of kernels.
inline constexpr double kMaxCoordinate_m = 1e4;

/// Appends translation (metres) and quaternion (x y z w) of `pose` to `out`.
void AddPose(const RigidTransform& pose, google::protobuf::RepeatedField<double>* out);
/// Returns the pose whose numbers start at `first`; nullopt if they are none.
std::optional<RigidTransform> PoseAt(const google::protobuf::RepeatedField<double>& numbers,
                                     int first);

SavedCamera ToSaved(const CameraModel& camera);
/// Returns nullopt if there was no such camera. Distortion coefficients that are missing are 0.
std::optional<CameraModel> FromSaved(const SavedCamera& saved);

/// Says how a rig's camera differs from a saved one; empty if it does not.
std::string Difference(const char* name, const SavedCamera& saved,
                       const std::optional<CameraModel>& camera);

}  // namespace isotherm
