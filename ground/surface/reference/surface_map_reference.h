#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "common/testing/kernel_checks.h"
#include "ground/surface/surface_map_kernel.h"

// These functions do what the kernel beside this folder must do, one element at a time and in
// double precision: they are its specification. Compiled for tests only.
namespace isotherm::reference {

using testing::AtLeastZero;
using testing::Both;
using testing::Tribool;

/// Holds what SurfaceMapRow must make of a pixel.
struct MapPixel {
  Tribool has_normal = Tribool::kNo;
  Eigen::Vector3d p, n;
  double n_slack = 0.0;
};

inline MapPixel MakeMapPixel(const SurfaceMapArgs& a, int x, int y) {
  constexpr double kMaxBend = 0.3;
  const Image<float>& depth = *a.depth_m;
  MapPixel result;
  if (std::min(x, y) < a.reach || x + a.reach >= depth.width() || y + a.reach >= depth.height())
    return result;
  const auto vertex = [&](int u, int v) {
    const double z = depth.At(u, v);
    return Eigen::Vector3d((u - double{a.cx}) / a.fx * z, (v - double{a.cy}) / a.fy * z, z);
  };
  result.p = vertex(x, y);
  const Eigen::Vector3d left = vertex(x - a.reach, y);
  const Eigen::Vector3d right = vertex(x + a.reach, y);
  const Eigen::Vector3d up = vertex(x, y - a.reach);
  const Eigen::Vector3d down = vertex(x, y + a.reach);
  const double z = result.p.z();
  const double slack = testing::kSinglePrecision * (z + 1e-3);
  result.has_normal = z > 0.0 ? Tribool::kYes : Tribool::kNo;
  for (const double neighbour : {left.z(), right.z(), up.z(), down.z()}) {
    if (!(neighbour > 0.0)) result.has_normal = Tribool::kNo;
    result.has_normal =
        Both(result.has_normal, AtLeastZero(a.max_step * z - std::abs(neighbour - z), slack));
  }
  const auto even = [&](double before, double after) {
    const double bend = std::abs(before + after - 2.0 * z);
    return AtLeastZero(kMaxBend * std::abs(after - before) + a.noise_at_1m * z * z - bend,
                       4.0 * slack);
  };
  result.has_normal = Both(result.has_normal, even(left.z(), right.z()));
  result.has_normal = Both(result.has_normal, even(up.z(), down.z()));
  const Eigen::Vector3d across = right - left;
  const Eigen::Vector3d along = down - up;
  const Eigen::Vector3d cross = along.cross(across);
  result.n = cross.normalized();
  // Of differences of vertices in single precision.
  result.n_slack = 4.0 * slack * (across.norm() + along.norm()) / cross.norm() + 1e-5;
  return result;
}

}  // namespace isotherm::reference
