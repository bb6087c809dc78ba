#pragma once

#include <vector>

#include "common/geometry/rigid_transform.h"
#include "common/radiometry/radiometry.h"
#include "common/simulation/ray_caster.h"
#include "common/simulation/scene.h"

namespace isotherm {

/// Emissivity of a scene's materials over the cosine of the emission angle, from tables.
class EmissivityTables {
 public:
  explicit EmissivityTables(const Scene& scene);
  double At(int material, float cosine) const;

 private:
  std::vector<std::vector<float>> tables_;  ///< Per material.
};

/// Band radiance that reaches a camera along its rays: directional emissivity and reflected
/// surroundings (thesis eq. 3.1, B.2). What it is made of must outlive it. Thread-safe (immutable).
class RadianceView {
 public:
  RadianceView(const Scene& scene, const BandRadiance& band, const EmissivityTables& emissivity,
               const RigidTransform& T_world_camera);

  /// Radiance along the ray (x, y, 1), which meets the primitive at depth `z_m`; below 0 = none.
  double At(int primitive, const Eigen::Vector2f& ray, float z_m) const;

 private:
  double MirrorRadiance(const Eigen::Vector2f& ray, double emissivity) const;

  const Scene& scene_;
  const BandRadiance& band_;
  const EmissivityTables& emissivity_;
  const RigidTransform T_world_camera_;
  const CameraView view_;
  const double surround_;
};

}  // namespace isotherm
