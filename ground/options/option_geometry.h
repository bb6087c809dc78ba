#pragma once

#include <Eigen/Geometry>
#include <string>
#include <vector>

#include "common/base/status.h"
#include "common/geometry/rigid_transform.h"

namespace isotherm {

class BoxOptions;
class PoseOptions;

/// Fails if a number is missing or not finite, or if the quaternion's length is not 1 within 1 %.
Result<RigidTransform> ToTransform(const PoseOptions& pose);
PoseOptions ToOptions(const RigidTransform& pose);
/// The arguments that make it the first pose of a scan: "--set",
/// "volume.expert.initial_pose.x_m=0.1", ...
std::vector<std::string> InitialPoseArguments(const RigidTransform& pose);

/// Fails if a number is missing or not finite, or if one of max is not larger than that of min.
Result<Eigen::AlignedBox3d> ToBox(const BoxOptions& box);
BoxOptions ToOptions(const Eigen::AlignedBox3d& box);

}  // namespace isotherm
