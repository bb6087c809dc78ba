#include "ground/thermal/camera_motion.h"

#include <Eigen/Geometry>

namespace isotherm {

CameraMotion MotionBetween(const RigidTransform& T_map_before, const RigidTransform& T_map_after,
                           double interval_s) {
  CameraMotion motion;
  if (!(interval_s > 0.0)) return motion;
  const RigidTransform T_before_after = T_map_before.inverse() * T_map_after;
  const Eigen::AngleAxisd rotation(T_before_after.linear());
  motion.rate_rad_s = rotation.angle() / interval_s * rotation.axis();
  // The axes turn by the way: those in the middle are the fairest for the whole interval.
  const Eigen::AngleAxisd half(-0.5 * rotation.angle(), rotation.axis());
  motion.velocity_m_s = half * T_before_after.translation() / interval_s;
  return motion;
}

CameraMotion MotionOf(const CameraMotion& motion, const RigidTransform& T_other_camera) {
  // The other camera's origin in this one's coordinates.
  const Eigen::Vector3d p_other = T_other_camera.inverse().translation();
  const Eigen::Matrix3d R = T_other_camera.linear();
  return {R * (motion.velocity_m_s + motion.rate_rad_s.cross(p_other)), R * motion.rate_rad_s};
}

Eigen::Vector2d ImageVelocity(const CameraMotion& motion, const Eigen::Vector2d& xy, double z_m) {
  const Eigen::Vector3d p(xy.x(), xy.y(), 1.0);
  const Eigen::Vector3d relative = -motion.velocity_m_s / z_m - motion.rate_rad_s.cross(p);
  return relative.head<2>() - xy * relative.z();
}

}  // namespace isotherm
