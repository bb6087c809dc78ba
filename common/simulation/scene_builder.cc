#include "common/simulation/scene_builder.h"

#include <utility>

#include "common/base/check.h"
#include "common/base/units.h"

namespace isotherm {
namespace {

using Eigen::Vector3d;

RigidTransform At(const Vector3d& center, const Eigen::Quaterniond& rotation) {
  return MakeTransform(center, rotation);
}

/// Turns +z into `direction`.
Eigen::Quaterniond Towards(const Vector3d& direction) {
  return Eigen::Quaterniond::FromTwoVectors(Vector3d::UnitZ(), direction);
}

}  // namespace

void SceneBuilder::UseMaterial(const Material& material) { materials_.push_back(material); }

Primitive& SceneBuilder::Box(std::string name, const Vector3d& low, const Vector3d& high) {
  CHECK((high.array() > low.array()).all());
  return Add(std::move(name), Shape::kBox, (high - low) / 2.0,
             At((low + high) / 2.0, Eigen::Quaterniond::Identity()));
}

Primitive& SceneBuilder::RotatedBox(std::string name, const Vector3d& center, const Vector3d& edges,
                                    const Vector3d& angles_deg) {
  const Vector3d angles_rad = angles_deg * kRadPerDeg;
  const Eigen::Quaterniond rotation(Eigen::AngleAxisd(angles_rad.z(), Vector3d::UnitZ()) *
                                    Eigen::AngleAxisd(angles_rad.y(), Vector3d::UnitY()) *
                                    Eigen::AngleAxisd(angles_rad.x(), Vector3d::UnitX()));
  return Add(std::move(name), Shape::kBox, edges / 2.0, At(center, rotation));
}

Primitive& SceneBuilder::Sphere(std::string name, const Vector3d& center, double radius) {
  return Add(std::move(name), Shape::kSphere, {radius, 0.0, 0.0},
             At(center, Eigen::Quaterniond::Identity()));
}

Primitive& SceneBuilder::Cylinder(std::string name, const Vector3d& from, const Vector3d& to,
                                  double radius) {
  return Add(std::move(name), Shape::kCylinder, {radius, 0.0, (to - from).norm() / 2.0},
             At((from + to) / 2.0, Towards(to - from)));
}

Primitive& SceneBuilder::Tube(std::string name, const Vector3d& from, const Vector3d& to,
                              double outer_radius, double inner_radius) {
  CHECK(inner_radius < outer_radius);
  return Add(std::move(name), Shape::kTube, {outer_radius, inner_radius, (to - from).norm() / 2.0},
             At((from + to) / 2.0, Towards(to - from)));
}

Primitive& SceneBuilder::Disc(std::string name, const Vector3d& center, const Vector3d& normal,
                              double outer_radius, double inner_radius) {
  return Add(std::move(name), Shape::kDisc, {outer_radius, inner_radius, 0.0},
             At(center, Towards(normal)));
}

Primitive& SceneBuilder::Add(std::string name, Shape shape, const Vector3d& size,
                             const RigidTransform& T_world_primitive) {
  CHECK(!materials_.empty());
  Primitive& primitive = primitives_.emplace_back();
  primitive.name = std::move(name);
  primitive.shape = shape;
  primitive.size = size;
  primitive.T_world_primitive = T_world_primitive;
  primitive.temperature = Uniform(surround_celsius_);
  primitive.material = static_cast<int>(materials_.size()) - 1;
  return primitive;
}

Scene SceneBuilder::Build(std::string name) const {
  return Scene(std::move(name), primitives_, materials_, surround_celsius_);
}

TemperatureField Uniform(double celsius) {
  TemperatureField field;
  field.near_celsius = field.far_celsius = celsius;
  return field;
}

TemperatureField Linear(const Primitive& primitive, const Vector3d& near_world, double near_celsius,
                        const Vector3d& far_world, double far_celsius) {
  const RigidTransform T_primitive_world = primitive.T_world_primitive.inverse();
  TemperatureField field;
  field.kind = TemperatureField::Kind::kLinear;
  field.near_celsius = near_celsius;
  field.far_celsius = far_celsius;
  field.origin = T_primitive_world * near_world;
  field.direction = T_primitive_world.linear() * (far_world - near_world).normalized();
  field.length_m = (far_world - near_world).norm();
  return field;
}

TemperatureField Radial(const Primitive& primitive, const Vector3d& center_world,
                        const Vector3d& axis_world, double center_celsius, double radius_m,
                        double far_celsius) {
  const RigidTransform T_primitive_world = primitive.T_world_primitive.inverse();
  TemperatureField field;
  field.kind = TemperatureField::Kind::kRadial;
  field.near_celsius = center_celsius;
  field.far_celsius = far_celsius;
  field.origin = T_primitive_world * center_world;
  field.direction = T_primitive_world.linear() * axis_world.normalized();
  field.length_m = radius_m;
  return field;
}

}  // namespace isotherm
