#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <optional>
#include <unordered_map>
#include <vector>

#include "ground/mesh/part_mesher.h"
#include "ground/thermal/thermal_volume.h"
#include "ground/tsdf/tsdf_volume.h"

namespace isotherm {

/// A ray in the coordinates of a model, metres.
struct SurfaceRay {
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();
  Eigen::Vector3d direction = Eigen::Vector3d::UnitZ();  ///< Any length but 0.
};

/// Where a ray meets the surface.
struct ProbeHit {
  Eigen::Vector3d point = Eigen::Vector3d::Zero();
  Eigen::Vector3f normal = Eigen::Vector3f::Zero();  ///< Unit, towards the observed side.
  double distance_m = 0.0;                           ///< From the ray's origin.
};

/// Looks at the surface of a model as it is shown: the mesh, made block by block where it is asked
/// for and kept. Valid while the model does not change. Thread-compatible.
class SurfaceProbe {
 public:
  SurfaceProbe(const TsdfVolume& tsdf, const ThermalVolume& thermal, const SurfaceOptions& options)
      : tsdf_(tsdf), thermal_(thermal), mesher_(options) {}

  /// The first point at which the ray meets the surface, from either side, within `reach_m`.
  std::optional<ProbeHit> Cast(const SurfaceRay& ray, double reach_m);
  /// The part of the mesh whose cubes start in a block; empty where there is none.
  const Surface& PartAt(const GridIndex& block);

  const TsdfVolume& tsdf() const { return tsdf_; }
  const ThermalVolume& thermal() const { return thermal_; }

 private:
  const TsdfVolume& tsdf_;
  const ThermalVolume& thermal_;
  PartMesher mesher_;
  std::unordered_map<std::int32_t, Surface> parts_;
};

/// Where a ray meets a triangle (T. Möller, B. Trumbore, "Fast, minimum storage ray-triangle
/// intersection", 1997), from either side.
struct TriangleHit {
  double distance = 0.0;    ///< In lengths of the ray's direction.
  double u = 0.0, v = 0.0;  ///< Weights of the second and third corner.
};
std::optional<TriangleHit> IntersectTriangle(const SurfaceRay& ray, const Eigen::Vector3d& a,
                                             const Eigen::Vector3d& b, const Eigen::Vector3d& c);

}  // namespace isotherm
