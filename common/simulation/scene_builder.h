#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "common/simulation/scene.h"

namespace isotherm {

/// Collects primitives in `world` coordinates. Angles in degrees, because scenes are written by
/// hand. Thread-compatible.
class SceneBuilder {
 public:
  explicit SceneBuilder(double surround_celsius) : surround_celsius_(surround_celsius) {}

  /// Materials are numbered in the order they are added; parts get the last one added.
  void UseMaterial(const Material& material);

  /// Axis-aligned box between two corners.
  Primitive& Box(std::string name, const Eigen::Vector3d& low, const Eigen::Vector3d& high);
  /// Box with a centre, edge lengths and a rotation around the axes x, then y, then z.
  Primitive& RotatedBox(std::string name, const Eigen::Vector3d& center,
                        const Eigen::Vector3d& edges, const Eigen::Vector3d& angles_deg);
  Primitive& Sphere(std::string name, const Eigen::Vector3d& center, double radius);
  /// Between the centres of two ends.
  Primitive& Cylinder(std::string name, const Eigen::Vector3d& from, const Eigen::Vector3d& to,
                      double radius);
  Primitive& Tube(std::string name, const Eigen::Vector3d& from, const Eigen::Vector3d& to,
                  double outer_radius, double inner_radius);
  /// Flat, facing `normal`.
  Primitive& Disc(std::string name, const Eigen::Vector3d& center, const Eigen::Vector3d& normal,
                  double outer_radius, double inner_radius = 0.0);

  Scene Build(std::string name) const;

 private:
  Primitive& Add(std::string name, Shape shape, const Eigen::Vector3d& size,
                 const RigidTransform& T_world_primitive);

  double surround_celsius_;
  std::vector<Primitive> primitives_;
  std::vector<Material> materials_;
};

/// One temperature everywhere.
TemperatureField Uniform(double celsius);
/// From `near_celsius` at one point in `world` to `far_celsius` at another.
TemperatureField Linear(const Primitive& primitive, const Eigen::Vector3d& near_world,
                        double near_celsius, const Eigen::Vector3d& far_world, double far_celsius);
/// From `center_celsius` on a line through `center_world` along `axis_world` to `far_celsius` at
/// `radius_m` from it.
TemperatureField Radial(const Primitive& primitive, const Eigen::Vector3d& center_world,
                        const Eigen::Vector3d& axis_world, double center_celsius, double radius_m,
                        double far_celsius);

}  // namespace isotherm
