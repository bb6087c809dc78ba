#include "ground/camera_calibration/lens_rays.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <cmath>
#include <limits>
#include <vector>

namespace isotherm {
namespace {

/// The members of `camera` that a lens's parameters are, in their order.
template <typename Camera>
auto Members(LensKind kind, Camera& c) {
  using Member = decltype(&c.fx);
  std::vector<Member> members = {&c.fx, &c.fy, &c.cx, &c.cy, &c.k1, &c.k2};
  if (kind == LensKind::kFisheye) {
    members.insert(members.end(), {&c.k3, &c.k4});
    return members;
  }
  members.insert(members.end(), {&c.p1, &c.p2, &c.k3});
  if (kind == LensKind::kRational) members.insert(members.end(), {&c.k4, &c.k5, &c.k6});
  return members;
}

}  // namespace

LensParameters ParametersOf(const CameraModel& camera) {
  LensParameters lens{};
  std::size_t i = 0;
  for (const double* member : Members(camera.lens, camera)) lens[i++] = *member;
  return lens;
}

CameraModel CameraOf(LensKind kind, const LensParameters& lens, const Eigen::Vector2i& size_px) {
  CameraModel camera;
  camera.width = size_px.x();
  camera.height = size_px.y();
  camera.lens = kind;
  std::size_t i = 0;
  for (double* member : Members(kind, camera)) *member = lens[i++];
  return camera;
}

Eigen::Vector2d ProjectRay(LensKind kind, const LensParameters& lens, const Eigen::Vector3d& ray) {
  Eigen::Vector2d pixel = Eigen::Vector2d::Constant(std::numeric_limits<double>::quiet_NaN());
  ProjectLens(kind, lens.data(), ray.data(), pixel.data());
  return pixel;
}

std::optional<Eigen::Vector3d> RayThrough(LensKind kind, const LensParameters& lens,
                                          const Eigen::Vector2d& pixel) {
  Eigen::Vector3d ray((pixel.x() - lens[2]) / lens[0], (pixel.y() - lens[3]) / lens[1], 1.0);
  constexpr int kMaxIterations = 60;
  constexpr double kConverged_px = 1e-9, kStep = 1e-6, kMaxStep = 0.3;
  for (int i = 0; i < kMaxIterations; ++i) {
    const Eigen::Vector2d at = ProjectRay(kind, lens, ray);
    const Eigen::Vector2d error = pixel - at;
    if (!error.allFinite()) return std::nullopt;
    Eigen::Matrix2d slope;
    for (int axis = 0; axis < 2; ++axis) {
      Eigen::Vector3d moved = ray;
      moved[axis] += kStep;
      slope.col(axis) = (ProjectRay(kind, lens, moved) - at) / kStep;
    }
    // A lens that shows more at a pixel farther out turns no image round.
    if (!(slope.determinant() > 0.0)) return std::nullopt;
    if (error.norm() < kConverged_px) return ray;
    Eigen::Vector2d step = slope.inverse() * error;
    if (step.norm() > kMaxStep) step *= kMaxStep / step.norm();
    ray.head<2>() += step;
  }
  return std::nullopt;
}

Eigen::Matrix2Xd ProjectionByLens(LensKind kind, const LensParameters& lens,
                                  const Eigen::Vector3d& ray) {
  const int count = LensParameterCount(kind);
  Eigen::Matrix2Xd slope(2, count);
  for (int i = 0; i < count; ++i) {
    constexpr double kStep = 1e-4;
    LensParameters low = lens, high = lens;
    low[static_cast<std::size_t>(i)] -= kStep;
    high[static_cast<std::size_t>(i)] += kStep;
    slope.col(i) = (ProjectRay(kind, high, ray) - ProjectRay(kind, low, ray)) / (2.0 * kStep);
  }
  return slope;
}

Eigen::Matrix<double, 2, 3> ProjectionByRotation(LensKind kind, const LensParameters& lens,
                                                 const Eigen::Vector3d& ray) {
  Eigen::Matrix<double, 2, 3> slope;
  for (int axis = 0; axis < 3; ++axis) {
    // Central differences: their error is least near the cube root of the rounding of doubles.
    constexpr double kStep_rad = 1e-5;
    const Eigen::Vector3d rotation = kStep_rad * Eigen::Vector3d::Unit(axis);
    slope.col(axis) = (ProjectRay(kind, lens, ray + rotation.cross(ray)) -
                       ProjectRay(kind, lens, ray - rotation.cross(ray))) /
                      (2.0 * kStep_rad);
  }
  return slope;
}

bool IsInner(const Eigen::Vector2d& pixel, const Eigen::Vector2i& size_px) {
  // The middle 80 % each way: what is outside belongs to the corners' figure. Not tuned.
  constexpr double kHalfPart = 0.4;
  const Eigen::Vector2d middle = 0.5 * (size_px.cast<double>() - Eigen::Vector2d::Ones());
  return std::abs(pixel.x() - middle.x()) <= kHalfPart * size_px.x() &&
         std::abs(pixel.y() - middle.y()) <= kHalfPart * size_px.y();
}

}  // namespace isotherm
