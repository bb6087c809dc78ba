#pragma once

#include <Eigen/Core>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "common/radiometry/radiometry.h"
#include "common/simulation/primitive.h"

namespace isotherm {

/// A point on a true surface.
struct SurfacePoint {
  Eigen::Vector3d p_world;
  Eigen::Vector3d n_world;  ///< Unit length; towards the viewer if there is one, otherwise outward.
  double celsius = 0.0;     ///< True temperature.
  int primitive = 0;        ///< Index into Scene::primitives().
};

/// Describes the first place where a ray meets the scene.
struct SurfaceHit {
  double distance = 0.0;  ///< In lengths of the ray's direction.
  SurfacePoint point;
};

/// An analytic scene: shapes with true geometry and temperature in uniform surroundings. Everything
/// it answers is exact. Thread-safe (immutable).
class Scene {
 public:
  Scene(std::string name, std::vector<Primitive> primitives, std::vector<Material> materials,
        double surround_celsius);

  const std::string& name() const { return name_; }
  const std::vector<Primitive>& primitives() const { return primitives_; }
  const std::vector<Material>& materials() const { return materials_; }
  double surround_celsius() const { return surround_celsius_; }
  const Material& MaterialOf(int primitive) const;

  /// First surface that a ray from `origin` along `direction` meets; nullopt = the surroundings.
  std::optional<SurfaceHit> Intersect(const Eigen::Vector3d& origin_world,
                                      const Eigen::Vector3d& direction_world) const;

  /// True temperature of a point on `primitive`.
  double TrueCelsius(int primitive, const Eigen::Vector3d& p_world) const;

  /// Returns whether the point is inside or within `tolerance_m` of a primitive other than
  /// `except`.
  bool IsCovered(const Eigen::Vector3d& p_world, int except, double tolerance_m) const;

 private:
  std::string name_;
  std::vector<Primitive> primitives_;
  std::vector<Material> materials_;
  double surround_celsius_;
  std::vector<RigidTransform> T_primitive_world_;
  std::vector<double> bounding_radius_m_;
};

/// Returns what a thermal camera without noise and blur shows for a surface point seen from
/// `viewer_world`: directional emissivity and reflected surroundings (thesis eq. 3.1, B.2). Mirrors
/// reflect the scene (one bounce).
double TrueApparentCelsius(const Scene& scene, const BandRadiance& band, const SurfacePoint& point,
                           const Eigen::Vector3d& viewer_world);

/// The same as band radiance, with a given emissivity; the renderer's inner step.
double TrueRadiance(const Scene& scene, const BandRadiance& band, const SurfacePoint& point,
                    const Eigen::Vector3d& viewer_world, double emissivity);

}  // namespace isotherm
