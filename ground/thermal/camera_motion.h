#pragma once

#include <Eigen/Core>
#include <span>

#include "common/geometry/camera.h"
#include "common/geometry/rigid_transform.h"

namespace isotherm {

/// The motion of a camera in its own coordinates: m/s and rad/s.
struct CameraMotion {
  Eigen::Vector3d velocity_m_s = Eigen::Vector3d::Zero();
  Eigen::Vector3d rate_rad_s = Eigen::Vector3d::Zero();
};

/// The motion, taken as even, between two poses `interval_s` apart; none for an interval of 0.
CameraMotion MotionBetween(const RigidTransform& T_map_before, const RigidTransform& T_map_after,
                           double interval_s);

/// The motion at the end of an interval of `interval_s` over which it was `mean`, if it has changed
/// evenly since the interval of `before_s` just before, over which it was `before`.
CameraMotion MotionAtEnd(const CameraMotion& before, double before_s, const CameraMotion& mean,
                         double interval_s);

/// The one of `motions`, of which there is at least one, at which the image of a surface `depth_m`
/// away is the fastest, in its middle or in a corner.
CameraMotion FastestInImage(std::span<const CameraMotion> motions, const CameraModel& camera,
                            double depth_m);

/// The same motion of another camera on the rig: T_other_camera maps into its coordinates.
CameraMotion MotionOf(const CameraMotion& motion, const RigidTransform& T_other_camera);

/// Speed at which a resting point at normalised image coordinates `xy` and depth `z_m` goes through
/// the image, per second in normalised coordinates: with p = (x, y, 1), its velocity is
/// -v - w x (z p), and the image follows the projection's derivative.
Eigen::Vector2d ImageVelocity(const CameraMotion& motion, const Eigen::Vector2d& xy, double z_m);

}  // namespace isotherm
