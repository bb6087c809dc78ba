#include "ground/surface/testing/analytic_views.h"

#include <algorithm>
#include <cmath>

namespace isotherm::testing {

// These run for each step of each ray, most of the time of the tests that use them. Sums of
// coordinates instead of expressions of vectors, which sanitizers watch temporary by temporary.

double BallInCorner(const Eigen::Vector3d& p) {
  const double x = p.x() - 0.26, y = p.y() - 0.24, z = p.z() - 0.42;
  const double ball = std::sqrt(x * x + y * y + z * z) - 0.09;
  const double walls = std::min({0.62 - p.z(), 0.48 - p.x(), 0.42 - p.y()});
  return std::min(ball, walls);
}

double TraceDepth(const SignedDistance& distance_m, const CameraModel& camera,
                  const RigidTransform& T_world_camera, double u, double v) {
  const Eigen::Vector2d normalized = Unproject(camera, {u, v});
  const Eigen::Vector3d ray(normalized.x(), normalized.y(), 1.0);
  const Eigen::Vector3d direction = T_world_camera.linear() * ray;
  const Eigen::Vector3d origin = T_world_camera.translation();
  const double length = ray.norm();
  Eigen::Vector3d p = origin;
  double z = 0.0;
  for (int i = 0; i < 400 && z < 2.0; ++i) {
    const double d = distance_m(p);
    if (d < 1e-7) return z;
    z += d / length;
    for (int axis = 0; axis < 3; ++axis) p[axis] = origin[axis] + z * direction[axis];
  }
  return 0.0;
}

DepthFrame RenderDepth(const SignedDistance& distance_m, const CameraModel& camera,
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
