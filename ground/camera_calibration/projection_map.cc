#include "ground/camera_calibration/projection_map.h"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "ground/camera_calibration/lens_rays.h"

namespace isotherm {
namespace {

const Eigen::Vector2d kNothing =
    Eigen::Vector2d::Constant(std::numeric_limits<double>::quiet_NaN());

constexpr int kPoints = ProjectionMap::kColumns * ProjectionMap::kRows;

std::vector<std::optional<Eigen::Vector3d>> Rays(const BundleCamera& camera,
                                                 const ProjectionMap& map) {
  std::vector<std::optional<Eigen::Vector3d>> rays;
  for (int i = 0; i < kPoints; ++i)
    rays.push_back(RayThrough(camera.kind, camera.lens, map.PixelOf(i)));
  return rays;
}

Eigen::Matrix3d Rotation(const Eigen::Vector3d& vector) {
  const double angle = vector.norm();
  if (angle == 0.0) return Eigen::Matrix3d::Identity();
  return Eigen::AngleAxisd(angle, vector / angle).toRotationMatrix();
}

}  // namespace

Eigen::Vector2d ProjectionMap::PixelOf(int index) const {
  const int x = index % kColumns, y = index / kColumns;
  return {x * (size_px.x() - 1.0) / (kColumns - 1), y * (size_px.y() - 1.0) / (kRows - 1)};
}

double ProjectionMap::Rms(bool inner) const {
  double sum = 0.0;
  int count = 0;
  for (int i = 0; i < kPoints; ++i) {
    const double length = LengthAt(i);
    if (!std::isfinite(length) || (inner && !IsInner(PixelOf(i), size_px))) continue;
    sum += length * length;
    ++count;
  }
  return count > 0 ? std::sqrt(sum / count) : std::numeric_limits<double>::quiet_NaN();
}

double ProjectionMap::Max(bool inner) const {
  double largest = 0.0;
  for (int i = 0; i < kPoints; ++i) {
    const double length = LengthAt(i);
    if (std::isfinite(length) && (!inner || IsInner(PixelOf(i), size_px)))
      largest = std::max(largest, length);
  }
  return largest;
}

ProjectionMap ProjectionSigmas(const BundleCamera& camera, const Eigen::MatrixXd& covariance,
                               const Eigen::Vector2i& size_px) {
  ProjectionMap map;
  map.size_px = size_px;
  map.values_px.assign(kPoints, kNothing);
  const auto rays = Rays(camera, map);
  // The rotation that takes up most of what a change of the lens does to the inner image.
  Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
  Eigen::Matrix3Xd cross = Eigen::Matrix3Xd::Zero(3, covariance.rows());
  for (int i = 0; i < kPoints; ++i) {
    const auto& ray = rays[static_cast<std::size_t>(i)];
    if (!ray || !IsInner(map.PixelOf(i), size_px)) continue;
    const auto by_rotation = ProjectionByRotation(camera.kind, camera.lens, *ray);
    normal += by_rotation.transpose() * by_rotation;
    cross += by_rotation.transpose() * ProjectionByLens(camera.kind, camera.lens, *ray);
  }
  const Eigen::Matrix3Xd taken_up = normal.ldlt().solve(cross);
  for (int i = 0; i < kPoints; ++i) {
    const auto& ray = rays[static_cast<std::size_t>(i)];
    if (!ray) continue;
    const Eigen::Matrix2Xd slope = ProjectionByLens(camera.kind, camera.lens, *ray) -
                                   ProjectionByRotation(camera.kind, camera.lens, *ray) * taken_up;
    const Eigen::Matrix2d at = slope * covariance * slope.transpose();
    map.values_px[static_cast<std::size_t>(i)] = at.diagonal().cwiseMax(0.0).cwiseSqrt();
  }
  return map;
}

ProjectionMap CompareProjections(const BundleCamera& reference, const BundleCamera& other,
                                 const Eigen::Vector2i& size_px) {
  ProjectionMap map;
  map.size_px = size_px;
  map.values_px.assign(kPoints, kNothing);
  const auto rays = Rays(reference, map);
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
  constexpr int kIterations = 10;
  for (int iteration = 0; iteration < kIterations; ++iteration) {
    Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
    Eigen::Vector3d gradient = Eigen::Vector3d::Zero();
    for (int i = 0; i < kPoints; ++i) {
      const auto& ray = rays[static_cast<std::size_t>(i)];
      if (!ray || !IsInner(map.PixelOf(i), size_px)) continue;
      const Eigen::Vector3d turned = rotation * *ray;
      const auto slope = ProjectionByRotation(other.kind, other.lens, turned);
      normal += slope.transpose() * slope;
      gradient += slope.transpose() * (map.PixelOf(i) - ProjectRay(other.kind, other.lens, turned));
    }
    rotation = Rotation(normal.ldlt().solve(gradient)) * rotation;
  }
  for (int i = 0; i < kPoints; ++i) {
    const auto& ray = rays[static_cast<std::size_t>(i)];
    if (!ray) continue;
    map.values_px[static_cast<std::size_t>(i)] =
        ProjectRay(other.kind, other.lens, rotation * *ray) - map.PixelOf(i);
  }
  return map;
}

double FractionWithin(const ProjectionMap& differences, const ProjectionMap& standard_deviations,
                      double sigmas) {
  int within = 0, count = 0;
  for (int i = 0; i < kPoints; ++i) {
    const double difference = differences.LengthAt(i), sigma = standard_deviations.LengthAt(i);
    if (!std::isfinite(difference) || !std::isfinite(sigma)) continue;
    ++count;
    within += difference <= sigmas * sigma ? 1 : 0;
  }
  return count > 0 ? static_cast<double>(within) / count : 0.0;
}

}  // namespace isotherm
