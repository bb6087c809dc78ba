#include "ground/experiment/measurable_surface.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "common/base/units.h"
#include "common/simulation/scenes.h"
#include "common/simulation/surface_sampling.h"
#include "ground/experiment/raster_path.h"

namespace isotherm {
namespace {

/// Points are this far apart.
constexpr double kSpacing_m = 0.008;

/// There is room for a rig this far from everything.
constexpr double kRoom_m = 0.12;

/// Directions from a point to where it could be seen from: along the normal, and around it at half
/// and at nearly all of the good angle.
std::vector<Eigen::Vector3d> Directions(const Eigen::Vector3d& n_world, double good_rad) {
  // Steps of 45 degrees: a view that is free only between two of them is hard to find for an
  // operator, too.
  constexpr int kAround = 8;
  const Eigen::Vector3d u = n_world.unitOrthogonal(), v = n_world.cross(u);
  std::vector<Eigen::Vector3d> directions = {n_world};
  for (const double angle : {0.5 * good_rad, 0.9 * good_rad}) {
    for (int i = 0; i < kAround; ++i) {
      const double azimuth = 2.0 * std::numbers::pi * i / kAround;
      directions.push_back(std::cos(angle) * n_world +
                           std::sin(angle) * (std::cos(azimuth) * u + std::sin(azimuth) * v));
    }
  }
  return directions;
}

/// Says whether an operator before the scene can hold the rig there.
bool IsBefore(const SceneFront& front, const Eigen::Vector3d& viewer) {
  // An operator may stand a little beside the scene, not behind it.
  constexpr double kBeside_m = 0.2;
  return viewer.z() < front.median_z_m &&
         front.region_m.exteriorDistance(viewer.head<2>()) <= kBeside_m;
}

bool IsMeasurable(const Scene& scene, const SceneFront& front, const SurfacePoint& point,
                  const ThermalOptions& limits) {
  // Both cameras must see the point: a line of sight that only just passes something is none.
  constexpr double kOffSurface_m = 0.002;
  const double near_m = limits.distance().min_m(), far_m = limits.distance().good_m();
  const Eigen::Vector3d from = point.p_world + kOffSurface_m * point.n_world;
  for (const Eigen::Vector3d& direction :
       Directions(point.n_world, limits.angle().good_deg() * kRadPerDeg)) {
    const auto hit = scene.Intersect(from, direction);
    for (const double distance_m : {0.5 * (near_m + far_m), 0.9 * far_m}) {
      const Eigen::Vector3d viewer = point.p_world + distance_m * direction;
      if (hit && hit->distance < distance_m + kRoom_m) continue;
      if (IsBefore(front, viewer) && !scene.IsCovered(viewer, -1, kRoom_m)) return true;
    }
  }
  return false;
}

}  // namespace

MeasurableSurface::MeasurableSurface(const Scene& scene, const ThermalOptions& limits) {
  const SceneFront front = FrontOf(scene);
  for (const SurfaceSample& sample : SampleSurface(scene, kSpacing_m)) {
    const Eigen::Vector3d& p = sample.point.p_world;
    const bool in_volume = (p.array() > 0.0).all() && (p.array() < kSceneCube_m).all();
    if (in_volume && IsMeasurable(scene, front, sample.point, limits)) points_world_.push_back(p);
  }
}

double MeasurableSurface::MeasuredWell(const ScanModel& model) const {
  const auto is_well = [&](const Eigen::Vector3d& p_world) {
    for (int i = 0; i < model.atlas.size(); ++i) {
      const SubMap& map = model.atlas.map(i);
      if (!map.joined) continue;
      const ThermalVoxel voxel =
          ThermalVoxelAt(*map.tsdf, *map.thermal, map.T_world_map.inverse() * p_world);
      if (voxel.quality() == MeasurementQuality::kGood) return true;
    }
    return false;
  };
  if (points_world_.empty()) return 0.0;
  return static_cast<double>(std::ranges::count_if(points_world_, is_well)) /
         static_cast<double>(points_world_.size());
}

}  // namespace isotherm
