#pragma once

#include "common/geometry/rigid_transform.h"
#include "common/time/time_types.h"

namespace isotherm {

/// A pose of the depth camera on the time line.
struct StampedPose {
  CaptureTime time;
  RigidTransform T_world_depth;
};

}  // namespace isotherm
