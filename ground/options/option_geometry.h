#pragma once

#include <Eigen/Geometry>

#include "common/base/status.h"
#include "common/geometry/rigid_transform.h"

namespace isotherm {

class BoxOptions;
class PoseOptions;

/// Fails if a number is missing or not finite, or if the quaternion's length is not 1 within 1 %.
Result<RigidTransform> ToTransform(const PoseOptions& pose);
PoseOptions ToOptions(const RigidTransform& pose);

/// Fails if a number is missing or not finite, or if one of max is not larger than that of min.
Result<Eigen::AlignedBox3d> ToBox(const BoxOptions& box);
BoxOptions ToOptions(const Eigen::AlignedBox3d& box);

}  // namespace isotherm
