#pragma once

#include <algorithm>
#include <cmath>
#include <functional>

#include "common/frame/frame.h"
#include "common/geometry/camera.h"
#include "common/geometry/rigid_transform.h"

namespace isotherm::testing {

using SignedDistance = std::function<double(const Eigen::Vector3d& p_world)>;

/// A ball in the corner of three walls: constrains all six directions. Metres, `world`.
inline double BallInCorner(const Eigen::Vector3d& p) {
  const double ball = (p - Eigen::Vector3d(0.26, 0.24, 0.42)).norm() - 0.09;
  const double walls = std::min({0.62 - p.z(), 0.48 - p.x(), 0.42 - p.y()});
  return std::min(ball, walls);
}

inline CameraModel SmallDepthCamera() {
  CameraModel camera;
  camera.width = 320;
  camera.height = 240;
  camera.fx = camera.fy = 285.0;
  camera.cx = 159.5;
  camera.cy = 119.5;
  return camera;
}

/// Looks at the ball from about half a metre.
inline RigidTransform FirstPose() {
  return MakeTransform({0.30, 0.26, 0.0}, Eigen::Quaterniond::Identity());
}

/// Depth along z by sphere tracing of an exact signed distance; 0 = nothing within 2 m.
inline double TraceDepth(const SignedDistance& distance_m, const CameraModel& camera,
                         const RigidTransform& T_world_camera, double u, double v) {
  const Eigen::Vector2d normalized = Unproject(camera, {u, v});
  const Eigen::Vector3d ray(normalized.x(), normalized.y(), 1.0);
  const double length = ray.norm();
  double z = 0.0;
  for (int i = 0; i < 400 && z < 2.0; ++i) {
    const double d = distance_m(T_world_camera * Eigen::Vector3d(ray * z));
    if (d < 1e-7) return z;
    z += d / length;
  }
  return 0.0;
}

/// A noise-free depth frame in steps of 10 micrometres, much finer than a voxel.
inline DepthFrame RenderDepth(const SignedDistance& distance_m, const CameraModel& camera,
                              const RigidTransform& T_world_camera) {
  DepthFrame frame;
  frame.depth_scale = 50'000.0;
  frame.depth_raw = Image<std::uint16_t>(camera.width, camera.height);
  for (int v = 0; v < camera.height; ++v) {
    for (int u = 0; u < camera.width; ++u) {
      const double raw = TraceDepth(distance_m, camera, T_world_camera, u, v) * frame.depth_scale;
      frame.depth_raw.At(u, v) = raw < 65'535.0 ? static_cast<std::uint16_t>(std::lround(raw)) : 0;
    }
  }
  return frame;
}

}  // namespace isotherm::testing
