#pragma once

#include <functional>

#include "common/frame/frame.h"
#include "common/geometry/camera.h"
#include "common/geometry/rigid_transform.h"

namespace isotherm::testing {

using SignedDistance = std::function<double(const Eigen::Vector3d& p_world)>;

/// A ball in the corner of three walls: constrains all six directions. Metres, `world`.
double BallInCorner(const Eigen::Vector3d& p);

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
double TraceDepth(const SignedDistance& distance_m, const CameraModel& camera,
                  const RigidTransform& T_world_camera, double u, double v);

/// A noise-free depth frame in steps of 10 micrometres, much finer than a voxel.
DepthFrame RenderDepth(const SignedDistance& distance_m, const CameraModel& camera,
                       const RigidTransform& T_world_camera);

}  // namespace isotherm::testing
