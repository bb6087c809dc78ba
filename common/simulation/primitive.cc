#include "common/simulation/primitive.h"

#include <algorithm>
#include <cmath>

namespace isotherm {
namespace {

using Eigen::Vector3d;

// Faster than std::hypot, and metres do not overflow.
double AxisDistance(const Vector3d& p) { return std::sqrt(p.x() * p.x() + p.y() * p.y()); }

Vector3d BoxNormal(const Vector3d& half, const Vector3d& p) {
  int axis = 0;
  double farthest = -HUGE_VAL;
  for (int i = 0; i < 3; ++i) {
    const double beyond = std::abs(p[i]) - half[i];
    if (beyond > farthest) {
      farthest = beyond;
      axis = i;
    }
  }
  Vector3d normal = Vector3d::Zero();
  normal[axis] = p[axis] < 0.0 ? -1.0 : 1.0;
  return normal;
}

/// Cylinder and tube: the surface that the point is closest to wins.
Vector3d RoundNormal(const Vector3d& size, bool hollow, const Vector3d& p) {
  const double r = AxisDistance(p);
  const double to_outer = std::abs(r - size.x());
  const double to_cap = std::abs(std::abs(p.z()) - size.z());
  const double to_inner = hollow ? std::abs(r - size.y()) : HUGE_VAL;
  if (to_cap < to_outer && to_cap < to_inner) return {0.0, 0.0, p.z() < 0.0 ? -1.0 : 1.0};
  const double sign = to_inner < to_outer ? -1.0 : 1.0;
  return Vector3d(p.x(), p.y(), 0.0) * (sign / std::max(r, 1e-12));
}

}  // namespace

double TemperatureField::CelsiusAt(const Vector3d& p_primitive) const {
  if (kind == Kind::kUniform) return near_celsius;
  const Vector3d offset = p_primitive - origin;
  const double along = offset.dot(direction);
  double fraction = along / length_m;
  if (kind == Kind::kRadial) fraction = (offset - along * direction).norm() / length_m;
  fraction = std::clamp(fraction, 0.0, 1.0);
  if (kind == Kind::kRadial) fraction = fraction * fraction * (3.0 - 2.0 * fraction);
  return near_celsius + (far_celsius - near_celsius) * fraction;
}

Vector3d HalfExtents(const Primitive& primitive) {
  const Vector3d& s = primitive.size;
  switch (primitive.shape) {
    case Shape::kBox:
      return s;
    case Shape::kRectangle:
      return {s.x(), s.y(), 0.0};
    case Shape::kSphere:
      return {s.x(), s.x(), s.x()};
    case Shape::kCylinder:
    case Shape::kTube:
      return {s.x(), s.x(), s.z()};
    case Shape::kDisc:
      return {s.x(), s.x(), 0.0};
  }
  return Vector3d::Zero();
}

Vector3d NormalAt(const Primitive& primitive, const Vector3d& p_primitive) {
  switch (primitive.shape) {
    case Shape::kBox:
      return BoxNormal(primitive.size, p_primitive);
    case Shape::kSphere:
      return p_primitive.normalized();
    case Shape::kCylinder:
      return RoundNormal(primitive.size, false, p_primitive);
    case Shape::kTube:
      return RoundNormal(primitive.size, true, p_primitive);
    case Shape::kRectangle:
    case Shape::kDisc:
      break;
  }
  return Vector3d::UnitZ();
}

bool Contains(const Primitive& primitive, const Vector3d& p, double tolerance_m) {
  const Vector3d& s = primitive.size;
  switch (primitive.shape) {
    case Shape::kBox:
      return ((p.cwiseAbs() - s).array() <= tolerance_m).all();
    case Shape::kSphere:
      return p.norm() <= s.x() + tolerance_m;
    case Shape::kCylinder:
      return AxisDistance(p) <= s.x() + tolerance_m && std::abs(p.z()) <= s.z() + tolerance_m;
    case Shape::kTube:
      return AxisDistance(p) <= s.x() + tolerance_m && AxisDistance(p) >= s.y() - tolerance_m &&
             std::abs(p.z()) <= s.z() + tolerance_m;
    case Shape::kRectangle:
    case Shape::kDisc:
      break;
  }
  return false;
}

}  // namespace isotherm
