#pragma once

#include <Eigen/Core>
#include <span>

#include "common/geometry/rigid_transform.h"

namespace isotherm {

/// The rigid transform T that minimises the sum of |to[i] - T * from[i]|^2 (no scale; Umeyama,
/// "Least-squares estimation of transformation parameters between two point patterns", 1991). With
/// fewer than three points or points on a line the rotation about the line is arbitrary. Both sets
/// must have the same size.
RigidTransform AlignRigid(std::span<const Eigen::Vector3d> from,
                          std::span<const Eigen::Vector3d> to);

}  // namespace isotherm
