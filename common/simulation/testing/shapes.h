#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "common/simulation/primitive.h"

namespace isotherm {

// Signed distance to a solid shape (negative inside), independent of the closed-form intersections:
// the slow reference.

inline double SignedDistance(const Primitive& primitive, const Eigen::Vector3d& p) {
  const Eigen::Vector3d& s = primitive.size;
  const double r = std::hypot(p.x(), p.y());
  const auto in_plane = [](double u, double v) {
    return std::hypot(std::max(u, 0.0), std::max(v, 0.0)) + std::min(std::max(u, v), 0.0);
  };
  switch (primitive.shape) {
    case Shape::kBox: {
      const Eigen::Vector3d q = p.cwiseAbs() - s;
      return q.cwiseMax(0.0).norm() + std::min(q.maxCoeff(), 0.0);
    }
    case Shape::kSphere:
      return p.norm() - s.x();
    case Shape::kCylinder:
      return in_plane(r - s.x(), std::abs(p.z()) - s.z());
    case Shape::kTube: {
      const double middle = (s.x() + s.y()) / 2.0, half_wall = (s.x() - s.y()) / 2.0;
      return in_plane(std::abs(r - middle) - half_wall, std::abs(p.z()) - s.z());
    }
    case Shape::kRectangle: {
      const Eigen::Vector3d q = p.cwiseAbs() - Eigen::Vector3d(s.x(), s.y(), 0.0);
      return q.cwiseMax(0.0).norm();
    }
    case Shape::kDisc: {
      const double middle = (s.x() + s.y()) / 2.0, half_width = (s.x() - s.y()) / 2.0;
      const double beside = s.y() > 0.0 ? std::abs(r - middle) - half_width : r - s.x();
      return std::hypot(std::max(beside, 0.0), p.z());
    }
  }
  return HUGE_VAL;
}

/// One of each shape, at the origin.
inline std::vector<Primitive> OneOfEach() {
  const auto make = [](Shape shape, const Eigen::Vector3d& size) {
    Primitive primitive;
    primitive.shape = shape;
    primitive.size = size;
    return primitive;
  };
  return {make(Shape::kBox, {0.1, 0.2, 0.05}),    make(Shape::kRectangle, {0.2, 0.1, 0.0}),
          make(Shape::kSphere, {0.15, 0.0, 0.0}), make(Shape::kCylinder, {0.1, 0.0, 0.2}),
          make(Shape::kTube, {0.15, 0.12, 0.1}),  make(Shape::kDisc, {0.2, 0.08, 0.0}),
          make(Shape::kDisc, {0.2, 0.0, 0.0})};
}

}  // namespace isotherm
