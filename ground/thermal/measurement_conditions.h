#pragma once

#include "common/rig/sensor_models.h"
#include "ground/options/ground_options.pb.h"
#include "ground/thermal/thermal_volume.h"

namespace isotherm {

/// The distances and angles of (6.3a-b) in metres and as cosines, ready for inner loops.
struct ConditionLimits {
  float distance_min_m, distance_good_m, distance_max_m;
  float cosine_min_angle, cosine_good_angle, cosine_max_angle;

  /// Takes the limits of CompleteLimits(options, sensor).
  ConditionLimits(const ThermalOptions& options, const ThermalSensorModel& sensor);
  /// `complete` comes from CompleteLimits.
  explicit ConditionLimits(const ThermalOptions& complete);
  ConditionClass ClassifyDistance(float distance_m) const;
  /// `cosine` of the emission angle, 0..1.
  ConditionClass ClassifyAngle(float cosine) const;
};

/// SigmaCodes of two measurements; 0 = not known. And how far the temperatures are apart.
struct SigmaPair {
  std::uint8_t now = 0;
  std::uint8_t before = 0;
  double difference_k = 0.0;
};

/// Algorithm 6: whether a measurement under the new classes replaces one under the old classes.
/// Under equal distance and angle classes the motion classes decide, under equal ones of all three
/// the smaller uncertainty; the newer measurement if that is not known or the same, or if the two
/// do not agree, since one of them is wrong then, whatever its uncertainty, or the surface has
/// changed. A smeared measurement (kBad) replaces nothing.
bool ReplacesMeasurement(ConditionClass new_distance, ConditionClass new_angle,
                         ConditionClass new_motion, ThermalVoxel old, SigmaPair sigma = {});

}  // namespace isotherm
