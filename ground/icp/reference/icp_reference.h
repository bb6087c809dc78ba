#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <cstddef>

#include "common/testing/kernel_checks.h"
#include "ground/icp/icp_kernel.h"

// These functions do what the kernel beside this folder must do, one element at a time and in
// double precision: they are its specification. Compiled for tests only.
namespace isotherm::reference {

using testing::AtLeastZero;
using testing::Both;
using testing::Tribool;

/// Rounding of a sum of a few products in single precision.
inline constexpr double kIcpPrecision = 2e-6;

/// Holds a surface point and its normal in double precision.
struct Vertex {
  Eigen::Vector3d p, n;
};

inline Vertex At(const SurfaceMaps& maps, int x, int y) {
  return {Eigen::Vector3d(maps.vx.At(x, y), maps.vy.At(x, y), maps.vz.At(x, y)),
          Eigen::Vector3d(maps.nx.At(x, y), maps.ny.At(x, y), maps.nz.At(x, y))};
}

/// Holds what AccumulateIcpRows must add for one pixel.
struct Pair {
  Tribool candidate = Tribool::kNo;
  Tribool inlier = Tribool::kNo;
  std::array<double, 28> terms{};
};

inline Pair MakePair(const IcpKernelArgs& a, int x, int y) {
  const auto matrix = [](const float* R) {
    return Eigen::Matrix3d(
        Eigen::Map<const Eigen::Matrix<float, 3, 3, Eigen::RowMajor>>(R).cast<double>());
  };
  const auto vector = [](const float* t) {
    return Eigen::Vector3d(Eigen::Map<const Eigen::Vector3f>(t).cast<double>());
  };
  constexpr double kNearPixelBorder = 1e-3;
  Pair result;
  const Vertex current = At(*a.current, x, y);
  const Eigen::Vector3d arm = matrix(a.R_map_depth) * current.p;
  const Eigen::Vector3d p = arm + vector(a.t_map_depth);
  result.candidate = current.p.z() > 0.0 ? Tribool::kYes : Tribool::kNo;
  const Eigen::Vector3d above = p - vector(a.volume_min);
  const Eigen::Vector3d below = vector(a.volume_max) - p;
  for (int axis = 0; axis < 3; ++axis) {
    for (const double inside : {above[axis], below[axis]})
      result.candidate = Both(result.candidate, AtLeastZero(inside, kIcpPrecision));
  }
  const Eigen::Vector3d q = matrix(a.R_model_depth) * current.p + vector(a.t_model_depth);
  const double u = a.fx * q.x() / q.z() + a.cx + 0.5;
  const double v = a.fy * q.y() / q.z() + a.cy + 0.5;
  result.inlier = Both(result.candidate, AtLeastZero(q.z(), kIcpPrecision));
  for (const double pixel : {u, v}) {
    if (std::abs(pixel - std::round(pixel)) < kNearPixelBorder)
      result.inlier = Both(result.inlier, Tribool::kEither);
  }
  const int width = a.model->width();
  const int height = a.model->height();
  if (!(u >= 0.0 && u < width && v >= 0.0 && v < height)) {
    if (result.inlier == Tribool::kYes) result.inlier = Tribool::kNo;
    return result;
  }
  const Vertex model = At(*a.model, static_cast<int>(u), static_cast<int>(v));
  const Eigen::Vector3d difference = p - model.p;
  result.inlier = Both(
      result.inlier,
      AtLeastZero(double{a.max_squared_distance_m2} - difference.squaredNorm(), kIcpPrecision));
  result.inlier = Both(result.inlier, AtLeastZero(model.n.dot(matrix(a.R_map_depth) * current.n) -
                                                      double{a.min_normal_cosine},
                                                  kIcpPrecision));
  const double residual = model.n.dot(difference);
  const double weight = std::pow(a.reference_depth_m / current.p.z(), 4);
  Eigen::Matrix<double, 6, 1> J;
  J << model.n, arm.cross(model.n);
  std::size_t k = 0;
  for (int i = 0; i < 6; ++i) {
    for (int j = i; j < 6; ++j) result.terms[k++] = weight * J[i] * J[j];
  }
  for (int i = 0; i < 6; ++i) result.terms[k++] = weight * J[i] * residual;
  result.terms[k] = residual * residual;
  return result;
}

}  // namespace isotherm::reference
