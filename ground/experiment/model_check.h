#pragma once

#include <cmath>
#include <vector>

#include "common/concurrency/thread_pool.h"
#include "common/geometry/camera.h"
#include "common/simulation/scene.h"
#include "ground/export/surface.h"
#include "ground/renderer/view_maps.h"

namespace isotherm {

/// A point of the model beside the truth.
struct CheckedPoint {
  CloudPoint point;
  SurfacePoint truth;       ///< Where the true surface is met along the point's normal.
  double expected_celsius;  ///< Apparent, at right angles, of the true temperature.

  bool measured() const { return point.celsius == point.celsius; }
  /// Of a measured point: measured minus expected.
  double ErrorKelvin() const { return static_cast<double>(point.celsius) - expected_celsius; }
};

/// The points of the model's surface (algorithm 10), but for stray ones more than 6 mm away from
/// any true surface.
std::vector<CheckedPoint> CheckModel(const Scene& scene, const BandRadiance& band,
                                     const TsdfVolume& tsdf, const ThermalVolume& thermal,
                                     ThreadPool& pool);

/// Points that have a temperature, and those that have that of something else.
struct AssignmentCheck {
  std::size_t points = 0;
  std::size_t assigned = 0;
  std::size_t too_warm = 0;  ///< Of the assigned ones, by more than kWrongKelvin.
  std::size_t too_cold = 0;

  static constexpr double kWrongKelvin = 5.0;
  std::size_t wrong() const { return too_warm + too_cold; }
  double WrongPercent() const;
};
AssignmentCheck CheckAssignment(const std::vector<CheckedPoint>& points);

/// What the model shows from `T_world_camera`.
ViewMaps LookAtModel(const TsdfVolume& tsdf, const ThermalVolume& thermal,
                     const CameraModel& camera, const RigidTransform& T_world_camera,
                     ThreadPool& pool);

}  // namespace isotherm
