#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>

#include "common/geometry/rigid_transform.h"

namespace isotherm {

/// Closed-form shapes. The letters are Primitive::size, metres; axes are the primitive's own.
enum class Shape : std::uint8_t {
  kBox,        ///< Half edge lengths a, b, c along x, y, z.
  kRectangle,  ///< In z = 0: half edge lengths a, b. No thickness.
  kSphere,     ///< Radius a.
  kCylinder,   ///< Axis z: radius a, half length c. Closed.
  kTube,  ///< Axis z: outer radius a, inner radius b, half length c. Open ends with annular rims.
  kDisc,  ///< In z = 0: outer radius a, inner radius b (0 = full). No thickness.
};

/// True temperature on a primitive's surface, in the primitive's coordinates.
struct TemperatureField {
  /// Names the form of the field.
  enum class Kind : std::uint8_t {
    kUniform,  ///< `near_celsius` everywhere.
    kLinear,  ///< From `near_celsius` at `origin` to `far_celsius` at `length_m` along `direction`.
    kRadial,  ///< From `near_celsius` on the line `origin` + s `direction` to `far_celsius` at
              ///< `length_m` from it, smooth at both ends.
  };
  Kind kind = Kind::kUniform;
  double near_celsius = 23.0;
  double far_celsius = 23.0;
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();
  Eigen::Vector3d direction = Eigen::Vector3d::UnitZ();  ///< Unit length.
  double length_m = 1.0;

  double CelsiusAt(const Eigen::Vector3d& p_primitive) const;
};

/// Radiative properties of an opaque surface.
struct Material {
  double normal_emissivity = 0.96;
  double n = 1.5;       ///< Refractive index; 1.5 is paint.
  double kappa = 0.0;   ///< Extinction coefficient; metals have tens.
  bool mirror = false;  ///< Reflects the other parts, not only the surroundings.
};

/// A shape, where it is, how hot and of what.
struct Primitive {
  std::string name;
  Shape shape = Shape::kBox;
  Eigen::Vector3d size = Eigen::Vector3d::Zero();
  RigidTransform T_world_primitive = RigidTransform::Identity();
  TemperatureField temperature;
  int material = 0;  ///< Index into Scene::materials().
};

/// Half edge lengths of the smallest box around the shape, in its own axes.
Eigen::Vector3d HalfExtents(const Primitive& primitive);

/// Outward unit normal at a point on the surface, in the primitive's coordinates. Shapes without
/// thickness give +z.
Eigen::Vector3d NormalAt(const Primitive& primitive, const Eigen::Vector3d& p_primitive);

/// Returns whether the point (primitive's coordinates) is inside the solid or within `tolerance_m`
/// of it. Shapes without thickness contain nothing.
bool Contains(const Primitive& primitive, const Eigen::Vector3d& p_primitive, double tolerance_m);

}  // namespace isotherm
