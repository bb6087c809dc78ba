#pragma once

#include <cstddef>
#include <span>

#include "common/geometry/camera.h"
#include "common/geometry/rigid_transform.h"
#include "ground/evaluation/true_surface.h"

namespace isotherm {

/// When a true point counts as seen under acceptable conditions by the thermal camera.
struct WellSeenLimits {
  double min_distance_m = 0.30;
  double max_distance_m = 0.90;
  double min_angle_deg = 0.0;
  double max_angle_deg = 60.0;
};

/// Counts how much of what could be measured has a temperature.
struct ThermalCoverage {
  std::size_t well_seen = 0;  ///< True points that some pose saw under acceptable conditions.
  std::size_t covered = 0;    ///< Those with an assigned point of the cloud near by.
};

/// `T_truth_thermal`: true poses of the thermal camera. A true point is seen by a pose if it
/// projects into the image that `camera` takes, through its lens, and no other part of the true
/// surface lies before it: the samples' discs are drawn into a depth image at the camera's
/// resolution. It is covered if a point
/// of `assigned` (in the truth's world) lies within `radius_m`.
ThermalCoverage EvaluateThermalCoverage(const TrueSurface& truth, const CameraModel& camera,
                                        std::span<const RigidTransform> T_truth_thermal,
                                        const WellSeenLimits& limits,
                                        std::span<const Eigen::Vector3f> assigned, float radius_m);

}  // namespace isotherm
