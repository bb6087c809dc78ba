#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>
#include <vector>

#include "common/geometry/camera.h"
#include "common/geometry/rigid_transform.h"

namespace isotherm {

/// A camera without distortion whose rendering spans `fov_deg` degrees from left to right.
CameraModel RenderingCamera(int width, int height, double fov_deg);

/// T_world_camera of a camera at `from_world` with `at_world` in the middle of its rendering and
/// `up_world` pointing up in it. nullopt if the two places are one, or the line between them runs
/// along `up_world`.
std::optional<RigidTransform> LookAt(const Eigen::Vector3d& from_world,
                                     const Eigen::Vector3d& at_world,
                                     const Eigen::Vector3d& up_world);

/// Says where a model lies, and from where it was looked at when it was scanned.
struct ModelAspect {
  Eigen::Vector3d centre_world;     ///< Centre of the box around its points, metres.
  Eigen::Vector3d to_viewer_world;  ///< Unit: from the centre to where it was seen from.
  Eigen::Vector3d up_world;         ///< Unit: upwards in most of the scan's renderings.
  bool one_sided = true;            ///< It was looked at from one side only.
};

/// `points_world` on the surface, at least one; `T_world_camera` from where it was scanned. Without
/// poses, against z with -y up, as the first camera of a scan usually stands.
ModelAspect AspectOf(std::span<const Eigen::Vector3f> points_world,
                     std::span<const RigidTransform> T_world_camera);

/// T_world_camera that looks along -`to_viewer_world` and has all points in the rendering, as large
/// as they fit.
RigidTransform FrameAll(std::span<const Eigen::Vector3f> points_world,
                        const Eigen::Vector3d& to_viewer_world, const Eigen::Vector3d& up_world,
                        const CameraModel& camera);

/// Says how many views there are and which part of the circle they take.
struct OrbitOptions {
  int count = 12;
  double arc_deg = 360.0;  ///< 360: all around, evenly; less: to both sides of the aspect.
  std::optional<double> elevation_deg;  ///< Above the plane across `up`; nullopt: the aspect's.
};

/// Views around the model's `up` axis, from left to right, all at the same distance, from which all
/// points are in all renderings.
std::vector<RigidTransform> Orbit(std::span<const Eigen::Vector3f> points_world,
                                  const ModelAspect& aspect, const CameraModel& camera,
                                  const OrbitOptions& options);

}  // namespace isotherm
