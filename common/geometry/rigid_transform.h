#pragma once

#include <Eigen/Geometry>

namespace isotherm {

/// T_a_b maps point coordinates in coordinate frame b to coordinates in a: p_a = T_a_b * p_b.
/// Metres.
using RigidTransform = Eigen::Isometry3d;

/// Translation (metres) and unit quaternion to a transform. The quaternion is normalised.
RigidTransform MakeTransform(const Eigen::Vector3d& translation_m,
                             const Eigen::Quaterniond& rotation);

/// The pose between `a` (alpha = 0) and `b` (alpha = 1): linear in position, SLERP in orientation
/// (Ordonez Müller, Close range 3D thermography, eq. 6.1b-c).
RigidTransform Interpolate(const RigidTransform& a, const RigidTransform& b, double alpha);

/// Exponential map of a twist (translation_m, rotation_rad as an axis-angle vector), rotation
/// first: the rotation is Exp(rotation) and the translation is taken as it is (retraction used by
/// ICP).
RigidTransform TransformFromTwist(const Eigen::Matrix<double, 6, 1>& twist);

/// Angle of the relative rotation in radians, [0, pi].
double RotationAngle(const RigidTransform& a, const RigidTransform& b);

/// Distance between the origins in metres.
double TranslationDistance(const RigidTransform& a, const RigidTransform& b);

/// True if all entries are finite and the linear part is a rotation within `tolerance`.
bool IsRigid(const RigidTransform& transform, double tolerance = 1e-6);

}  // namespace isotherm
