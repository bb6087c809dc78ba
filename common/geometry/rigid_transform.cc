#include "common/geometry/rigid_transform.h"

#include <algorithm>
#include <cmath>

namespace isotherm {

RigidTransform MakeTransform(const Eigen::Vector3d& translation_m,
                             const Eigen::Quaterniond& rotation) {
  RigidTransform transform = RigidTransform::Identity();
  transform.linear() = rotation.normalized().toRotationMatrix();
  transform.translation() = translation_m;
  return transform;
}

RigidTransform Interpolate(const RigidTransform& a, const RigidTransform& b, double alpha) {
  const Eigen::Quaterniond q_a(a.rotation());
  const Eigen::Quaterniond q_b(b.rotation());
  return MakeTransform((1.0 - alpha) * a.translation() + alpha * b.translation(),
                       q_a.slerp(alpha, q_b));
}

RigidTransform TransformFromTwist(const Eigen::Matrix<double, 6, 1>& twist) {
  const Eigen::Vector3d rotation = twist.tail<3>();
  const double angle = rotation.norm();
  RigidTransform transform = RigidTransform::Identity();
  if (angle > 0.0) {
    transform.linear() = Eigen::AngleAxisd(angle, rotation / angle).toRotationMatrix();
  }
  transform.translation() = twist.head<3>();
  return transform;
}

double RotationAngle(const RigidTransform& a, const RigidTransform& b) {
  const Eigen::Quaterniond difference(Eigen::Matrix3d(a.linear().transpose() * b.linear()));
  return 2.0 * std::atan2(difference.vec().norm(), std::abs(difference.w()));
}

double TranslationDistance(const RigidTransform& a, const RigidTransform& b) {
  return (a.translation() - b.translation()).norm();
}

bool IsRigid(const RigidTransform& transform, double tolerance) {
  if (!transform.matrix().allFinite()) return false;
  const Eigen::Matrix3d R = transform.linear();
  return (R * R.transpose() - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff() < tolerance &&
         R.determinant() > 0.0;
}

}  // namespace isotherm
