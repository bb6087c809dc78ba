#include "ground/renderer/viewpoint.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "common/base/check.h"
#include "common/base/units.h"

namespace isotherm {
namespace {

// The model fills at most this part of the rendering, so that it does not touch the edges.
constexpr double kFill = 0.94;
// Mean of the unit vectors towards the cameras: 1 = all on one spot, 0 = all around. Below it, a
// scan went around its object (a half circle gives 0.64).
constexpr double kOneSided = 0.5;

/// Any unit vector across `axis`, the nearest to `wish`.
Eigen::Vector3d Across(const Eigen::Vector3d& axis, const Eigen::Vector3d& wish) {
  const Eigen::Vector3d across = wish - wish.dot(axis) * axis;
  // Shorter: the wish points along the axis, and its direction across is rounding.
  constexpr double kMin = 1e-6;
  return across.norm() > kMin ? across.normalized() : axis.unitOrthogonal();
}

/// R_world_camera: optical axis and up given; x right, y down, z forward.
Eigen::Matrix3d Orientation(const Eigen::Vector3d& forward, const Eigen::Vector3d& up) {
  Eigen::Matrix3d R_world_camera;
  R_world_camera.col(2) = forward.normalized();
  R_world_camera.col(1) = -Across(R_world_camera.col(2), up);
  R_world_camera.col(0) = R_world_camera.col(1).cross(R_world_camera.col(2));
  return R_world_camera;
}

/// Half of the rendering at distance 1, with its margin.
Eigen::Vector2d HalfExtent(const CameraModel& camera) {
  return {kFill * camera.width / 2.0 / camera.fx, kFill * camera.height / 2.0 / camera.fy};
}

/// A point (x, y, z) in camera axes from the centre is in view of a camera at (aside, -back) if
/// x - aside and aside - x are at most half_extent (z + back): the least back for a camera that
/// does not stand aside, to both sides, in metres, for x and y.
struct LeastBack {
  Eigen::Vector2d right = Eigen::Vector2d::Constant(-std::numeric_limits<double>::infinity());
  Eigen::Vector2d left = right;
};

LeastBack Fit(std::span<const Eigen::Vector3f> points_world, const Eigen::Vector3d& centre_world,
              const Eigen::Matrix3d& R_world_camera, const Eigen::Vector2d& half_extent) {
  LeastBack back;
  for (const Eigen::Vector3f& p_world : points_world) {
    const Eigen::Vector3d p = R_world_camera.transpose() * (p_world.cast<double>() - centre_world);
    for (int axis = 0; axis < 2; ++axis) {
      back.right[axis] = std::max(back.right[axis], p[axis] / half_extent[axis] - p.z());
      back.left[axis] = std::max(back.left[axis], -p[axis] / half_extent[axis] - p.z());
    }
  }
  return back;
}

RigidTransform Pose(const Eigen::Matrix3d& R_world_camera, const Eigen::Vector3d& position_world) {
  RigidTransform T_world_camera = RigidTransform::Identity();
  T_world_camera.linear() = R_world_camera;
  T_world_camera.translation() = position_world;
  return T_world_camera;
}

}  // namespace

CameraModel RenderingCamera(int width, int height, double fov_deg) {
  CameraModel camera;
  camera.width = width;
  camera.height = height;
  camera.fx = camera.fy = width / 2.0 / std::tan(fov_deg * kRadPerDeg / 2.0);
  camera.cx = (width - 1) / 2.0;
  camera.cy = (height - 1) / 2.0;
  return camera;
}

std::optional<RigidTransform> LookAt(const Eigen::Vector3d& from_world,
                                     const Eigen::Vector3d& at_world,
                                     const Eigen::Vector3d& up_world) {
  constexpr double kMin = 1e-6;  // Of a distance in metres, and of a sine.
  const Eigen::Vector3d forward = at_world - from_world;
  if (!(forward.norm() > kMin) ||
      !(forward.normalized().cross(up_world.normalized()).norm() > kMin)) {
    return std::nullopt;
  }
  return Pose(Orientation(forward, up_world), from_world);
}

ModelAspect AspectOf(std::span<const Eigen::Vector3f> points_world,
                     std::span<const RigidTransform> T_world_camera) {
  CHECK(!points_world.empty());
  Eigen::Vector3f low = points_world.front(), high = low;
  for (const Eigen::Vector3f& p : points_world) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  ModelAspect aspect{((low + high) / 2.0F).cast<double>(), -Eigen::Vector3d::UnitZ(),
                     -Eigen::Vector3d::UnitY(), true};
  if (T_world_camera.empty()) return aspect;
  Eigen::Vector3d to_viewers = Eigen::Vector3d::Zero(), up = Eigen::Vector3d::Zero();
  for (const RigidTransform& pose : T_world_camera) {
    to_viewers += (pose.translation() - aspect.centre_world).normalized();
    up -= pose.linear().col(1);
  }
  const auto count = static_cast<double>(T_world_camera.size());
  const RigidTransform& last = T_world_camera.back();
  aspect.one_sided = to_viewers.norm() / count >= kOneSided;
  aspect.to_viewer_world =
      aspect.one_sided ? to_viewers.normalized() : Eigen::Vector3d(-last.linear().col(2));
  aspect.up_world =
      up.norm() / count >= kOneSided ? up.normalized() : Eigen::Vector3d(-last.linear().col(1));
  return aspect;
}

RigidTransform FrameAll(std::span<const Eigen::Vector3f> points_world,
                        const Eigen::Vector3d& to_viewer_world, const Eigen::Vector3d& up_world,
                        const CameraModel& camera) {
  CHECK(!points_world.empty());
  const Eigen::Vector3d centre = points_world.front().cast<double>();
  const Eigen::Matrix3d R_world_camera = Orientation(-to_viewer_world, up_world);
  const Eigen::Vector2d half_extent = HalfExtent(camera);
  const LeastBack back = Fit(points_world, centre, R_world_camera, half_extent);
  // Standing aside makes both sides alike, and thereby the larger of them smallest.
  const Eigen::Vector2d aside = (back.right - back.left).cwiseProduct(half_extent) / 2.0;
  const double distance_m = ((back.right + back.left) / 2.0).maxCoeff();
  return Pose(R_world_camera,
              centre + R_world_camera * Eigen::Vector3d(aside.x(), aside.y(), -distance_m));
}

std::vector<RigidTransform> Orbit(std::span<const Eigen::Vector3f> points_world,
                                  const ModelAspect& aspect, const CameraModel& camera,
                                  const OrbitOptions& options) {
  const Eigen::Vector3d up = aspect.up_world;
  const Eigen::Vector3d ahead = Across(up, aspect.to_viewer_world);
  const double elevation = options.elevation_deg
                               ? *options.elevation_deg * kRadPerDeg
                               : std::asin(std::clamp(aspect.to_viewer_world.dot(up), -1.0, 1.0));
  const bool closed = options.arc_deg >= 360.0;
  const double step = options.arc_deg / std::max(closed ? options.count : options.count - 1, 1);
  const double first = closed || options.count == 1 ? 0.0 : -options.arc_deg / 2.0;
  std::vector<RigidTransform> views;
  double back_m = 0.0;
  for (int i = 0; i < options.count; ++i) {
    const Eigen::AngleAxisd rotation((first + step * i) * kRadPerDeg, up);
    const Eigen::Vector3d to_viewer =
        std::cos(elevation) * (rotation * ahead) + std::sin(elevation) * up;
    views.push_back(Pose(Orientation(-to_viewer, up), aspect.centre_world));
    // Nobody stands aside: a centre that stays in the middle does not jump from view to view.
    const LeastBack back =
        Fit(points_world, aspect.centre_world, views.back().linear(), HalfExtent(camera));
    back_m = std::max({back_m, back.right.maxCoeff(), back.left.maxCoeff()});
  }
  for (RigidTransform& view : views) view.translation() -= back_m * view.linear().col(2);
  return views;
}

}  // namespace isotherm
