#include "ground/thermal/measurement_conditions.h"

#include <cmath>

#include "common/base/units.h"
#include "ground/thermal/sigma_code.h"
#include "ground/thermal/thermal_options.h"

namespace isotherm {
namespace {

float CosineOfDegrees(double degrees) { return static_cast<float>(std::cos(degrees * kRadPerDeg)); }

/// Smaller is better: good before acceptable before unchecked.
int Rank(ConditionClass c) { return static_cast<int>(c); }

}  // namespace

ConditionLimits::ConditionLimits(const ThermalOptions& options, const ThermalSensorModel& sensor)
    : ConditionLimits(CompleteLimits(options, sensor)) {}

ConditionLimits::ConditionLimits(const ThermalOptions& o)
    : distance_min_m(static_cast<float>(o.distance().min_m())),
      distance_good_m(static_cast<float>(o.distance().good_m())),
      distance_max_m(static_cast<float>(o.distance().max_m())),
      cosine_min_angle(CosineOfDegrees(o.angle().min_deg())),
      cosine_good_angle(CosineOfDegrees(o.angle().good_deg())),
      cosine_max_angle(CosineOfDegrees(o.angle().max_deg())) {}

ConditionClass ConditionLimits::ClassifyDistance(float d) const {
  // Written so that NaN is bad.
  if (!(d >= distance_min_m && d <= distance_max_m)) return ConditionClass::kBad;
  return d <= distance_good_m ? ConditionClass::kGood : ConditionClass::kAcceptable;
}

ConditionClass ConditionLimits::ClassifyAngle(float cosine) const {
  if (!(cosine <= cosine_min_angle && cosine >= cosine_max_angle)) return ConditionClass::kBad;
  return cosine >= cosine_good_angle ? ConditionClass::kGood : ConditionClass::kAcceptable;
}

bool ReplacesMeasurement(ConditionClass new_distance, ConditionClass new_angle,
                         ConditionClass new_motion, ThermalVoxel old, SigmaPair sigma) {
  const auto valid = [](ConditionClass distance, ConditionClass angle) {
    return distance != ConditionClass::kBad && angle != ConditionClass::kBad;
  };
  // A smeared temperature is of another place; it does not even replace a bad one.
  if (new_motion == ConditionClass::kBad) return false;
  if (!old.measured() || !valid(old.distance_class(), old.angle_class())) return true;
  if (!valid(new_distance, new_angle)) return false;
  // In the order of Algorithm 6: distance before angle; motion, which it does not have, comes last.
  if (new_distance != old.distance_class()) return Rank(new_distance) < Rank(old.distance_class());
  if (new_angle != old.angle_class()) return Rank(new_angle) < Rank(old.angle_class());
  if (new_motion != old.motion_class()) return Rank(new_motion) < Rank(old.motion_class());
  // Between equals the newer one wins, unless it is less certain and agrees: then it adds nothing.
  if (sigma.before == 0 || sigma.now <= sigma.before) return true;
  const double allowed_k =
      SigmaCode::kAgree * std::hypot(SigmaCode::Kelvin(sigma.now), SigmaCode::Kelvin(sigma.before));
  return std::abs(sigma.difference_k) > allowed_k;
}

}  // namespace isotherm
