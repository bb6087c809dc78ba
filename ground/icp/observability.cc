#include "ground/icp/observability.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <cmath>

#include "ground/icp/icp_tracker.h"

namespace isotherm {
namespace {

constexpr int kStride = 2;  ///< Step between the pixels that are looked at.

struct MotionSums {
  Matrix6 H = Matrix6::Zero();  ///< Sum of J of the model's normals times J of the current ones.
  double weight = 0.0;
  double depth = 0.0;
  int count = 0;
};

Eigen::Vector3d At(const Image<float>& x_plane, const Image<float>& y_plane,
                   const Image<float>& z_plane, int x, int y) {
  return {x_plane.At(x, y), y_plane.At(x, y), z_plane.At(x, y)};
}

MotionSums Accumulate(const SurfaceMaps& current, const RigidTransform& T_map_depth,
                      const ModelView& model, const IcpLimits& limits) {
  MotionSums sums;
  const RigidTransform T_model_depth = model.T_map_depth.inverse() * T_map_depth;
  const CameraModel& camera = model.camera;
  const double max_squared = limits.max_distance_m * double{limits.max_distance_m};
  for (int y = 0; y < current.height(); y += kStride) {
    for (int x = 0; x < current.width(); x += kStride) {
      const Eigen::Vector3d p_depth = At(current.vx, current.vy, current.vz, x, y);
      if (!(p_depth.z() > 0.0)) continue;
      const Eigen::Vector3d p_model = T_model_depth * p_depth;
      if (!(p_model.z() > 0.0)) continue;
      const double u = camera.fx * p_model.x() / p_model.z() + camera.cx + 0.5;
      const double v = camera.fy * p_model.y() / p_model.z() + camera.cy + 0.5;
      if (!(u >= 0.0 && v >= 0.0 && u < model.maps.width() && v < model.maps.height())) continue;
      const int i = static_cast<int>(u);
      const int j = static_cast<int>(v);
      const Eigen::Vector3d arm = T_map_depth.linear() * p_depth;
      const Eigen::Vector3d q = At(model.maps.vx, model.maps.vy, model.maps.vz, i, j);
      if (!((arm + T_map_depth.translation() - q).squaredNorm() < max_squared)) continue;
      const Eigen::Vector3d n = At(model.maps.nx, model.maps.ny, model.maps.nz, i, j);
      const Eigen::Vector3d n_current =
          T_map_depth.linear() * At(current.nx, current.ny, current.nz, x, y);
      if (!(n.dot(n_current) > double{limits.min_normal_cosine})) continue;
      Vector6 model_jacobian;
      // One factor has the model's normal, the other the frame's. Both have noise, but not the
      // same: products average it out, where squares would add it to every direction, and a noisy
      // plane would look structured (ADR 7).
      model_jacobian << n, arm.cross(n);
      Vector6 current_jacobian;
      current_jacobian << n_current, arm.cross(n_current);
      const double weight = std::pow(kIcpReferenceDepth / p_depth.z(), 4);
      sums.H.noalias() += (weight * model_jacobian) * current_jacobian.transpose();
      sums.weight += weight;
      sums.depth += weight * p_depth.z();
      ++sums.count;
    }
  }
  return sums;
}

}  // namespace

Vector6 Observability::UnobservablePart(const Vector6& twist) const {
  const Eigen::Matrix<double, 6, Eigen::Dynamic, 0, 6, 6> slides = axes.leftCols(unobservable_axes);
  // Axes are orthonormal in scaled motions, where a rotation counts by what it moves at the scene's
  // depth.
  const Vector6 motion = twist.cwiseQuotient(scale);
  return scale.cwiseProduct(slides * (slides.transpose() * motion));
}

std::optional<Vector6> Observability::SolveObserved(const Matrix6& H, const Vector6& g) const {
  if (unobservable_axes == 6) return std::nullopt;
  const Eigen::Matrix<double, 6, Eigen::Dynamic, 0, 6, 6> basis =
      scale.asDiagonal() * axes.rightCols(6 - unobservable_axes);
  const Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, 6, 6> reduced =
      basis.transpose() * H * basis;
  const auto ldlt = reduced.ldlt();
  if (ldlt.info() != Eigen::Success || !ldlt.isPositive() ||
      ldlt.vectorD().minCoeff() <= 1e-9 * ldlt.vectorD().maxCoeff()) {
    return std::nullopt;
  }
  return basis * ldlt.solve(-(basis.transpose() * g));
}

Observability MeasureObservability(const SurfaceMaps& current, const RigidTransform& T_map_depth,
                                   const ModelView& model, const IcpLimits& limits,
                                   double min_strength) {
  Observability space;
  const MotionSums sums = Accumulate(current, T_map_depth, model, limits);
  // With fewer associations than this fraction of the pixels looked at, the sums say nothing
  // (IcpTest checks that a few measure nothing). Larger: new ground beside a known rim is tracked
  // without knowing what is unobservable. Not tuned.
  constexpr double kMinFraction = 0.05;
  const double looked_at =
      static_cast<double>(current.width()) * current.height() / (kStride * kStride);
  if (sums.count < kMinFraction * looked_at) return space;
  space.mean_depth_m = sums.depth / sums.weight;
  space.scale.tail<3>().setConstant(1.0 / space.mean_depth_m);
  // The product of two different factors is symmetric only in the mean.
  const Matrix6 symmetric = 0.5 / sums.weight * (sums.H + sums.H.transpose());
  const Eigen::SelfAdjointEigenSolver<Matrix6> solver(space.scale.asDiagonal() * symmetric *
                                                      space.scale.asDiagonal());
  if (solver.info() != Eigen::Success) return space;
  space.axes = solver.eigenvectors();
  space.strength = solver.eigenvalues();
  space.measured = true;
  while (min_strength > 0.0 && space.unobservable_axes < 6 &&
         space.strength(space.unobservable_axes) < min_strength)
    ++space.unobservable_axes;
  return space;
}

}  // namespace isotherm
