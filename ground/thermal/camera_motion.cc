#include "ground/thermal/camera_motion.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>

#include "common/base/check.h"

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

CameraMotion MotionAtEnd(const CameraMotion& before, double before_s, const CameraMotion& mean,
                         double interval_s) {
  const double span_s = before_s + interval_s;
  if (!(before_s > 0.0 && interval_s > 0.0)) return mean;
  // Means are the motions in the middle of their intervals, which are half of span_s apart.
  const double fraction = interval_s / span_s;
  return {mean.velocity_m_s + fraction * (mean.velocity_m_s - before.velocity_m_s),
          mean.rate_rad_s + fraction * (mean.rate_rad_s - before.rate_rad_s)};
}

CameraMotion FastestInImage(std::span<const CameraMotion> motions, const CameraModel& camera,
                            double depth_m) {
  CHECK(!motions.empty());
  const double right = camera.width - 1.0, bottom = camera.height - 1.0;
  const std::array<Eigen::Vector2d, 5> pixels = {
      {{0.5 * right, 0.5 * bottom}, {0.0, 0.0}, {right, 0.0}, {0.0, bottom}, {right, bottom}}};
  const auto speed = [&](const CameraMotion& motion) {
    double fastest = 0.0;
    for (const Eigen::Vector2d& pixel : pixels) {
      fastest = std::max(fastest, ImageVelocity(motion, Unproject(camera, pixel), depth_m).norm());
    }
    return fastest;
  };
  return *std::ranges::max_element(motions, {}, speed);
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
