#pragma once

#include <string_view>

#include "common/base/status.h"
#include "common/geometry/rigid_transform.h"

namespace isotherm {

/// "x y z qx qy qz qw": metres and a quaternion, which must have unit length within 1 %.
Result<RigidTransform> ParsePose(std::string_view text);

}  // namespace isotherm
