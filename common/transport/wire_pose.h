#pragma once

#include <optional>

#include "common/geometry/rigid_transform.h"
#include "common/transport/topics.h"

struct isotherm_wire_Pose;

namespace isotherm {

isotherm_wire_Pose ToWirePose(const RigidTransform& pose);
/// nullopt if a number is not finite or the quaternion is not of unit length.
std::optional<RigidTransform> FromWirePose(const isotherm_wire_Pose& pose);

}  // namespace isotherm
