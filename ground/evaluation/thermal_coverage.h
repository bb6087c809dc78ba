#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "common/concurrency/thread_pool.h"
#include "common/geometry/camera.h"
#include "common/geometry/rigid_transform.h"
#include "ground/evaluation/true_surface.h"

namespace isotherm {

/// When a true point counts as seen under acceptable conditions by the thermal camera.
struct WellSeenLimits {
  int min_poses = 1;  ///< So many poses must see it under these conditions.
  double min_distance_m = 0.30;
  double max_distance_m = 0.90;
  double min_angle_deg = 0.0;
  double max_angle_deg = 60.0;
};

/// Counts how much of what could be measured has a temperature.
struct ThermalCoverage {
  std::size_t well_seen = 0;  ///< True points that were seen under acceptable conditions.
  std::size_t covered = 0;  ///< Points of `well_seen` with an assigned point of the cloud near by.
  std::size_t measured_well =
      0;  ///< Points of `well_seen` whose nearest assigned point is of class good.
};

/// The points of a cloud that have a temperature, in the truth's world.
struct AssignedPoints {
  std::vector<Eigen::Vector3f> positions_m;
  std::vector<bool> good;  ///< The point is of class good in distance, angle and motion.
};

/// A thermal camera and where it truly was.
struct ThermalViews {
  const CameraModel& camera;
  std::span<const RigidTransform> T_truth_thermal;
};

/// The points of a cloud, and how far from one of them a true point may be to be covered.
struct CoveringPoints {
  const AssignedPoints& assigned;
  float radius_m;
};

/// For each of `limits`. A true point is seen by a view if it projects into the image that the
/// camera takes, through its lens, and no other part of the true surface lies before it: the
/// samples' discs are drawn into a depth image at the camera's resolution.
std::vector<ThermalCoverage> EvaluateThermalCoverage(const TrueSurface& truth,
                                                     const ThermalViews& views,
                                                     std::span<const WellSeenLimits> limits,
                                                     const CoveringPoints& cloud, ThreadPool& pool);

}  // namespace isotherm
