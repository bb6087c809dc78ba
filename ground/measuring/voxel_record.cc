#include "ground/measuring/voxel_record.h"

#include <fmt/format.h>

#include <cmath>

#include "ground/mesh/face_measurement.h"
#include "ground/thermal/condition_record.h"

namespace isotherm {
namespace {

measuring::Condition ToCondition(ConditionClass condition) {
  switch (condition) {
    case ConditionClass::kBad:
      return measuring::BAD;
    case ConditionClass::kGood:
      return measuring::GOOD;
    case ConditionClass::kAcceptable:
      return measuring::ACCEPTABLE;
    case ConditionClass::kUnchecked:
      break;
  }
  return measuring::UNCHECKED;
}

const char* VerdictOf(ConditionClass condition) {
  return condition == ConditionClass::kBad ? "bad" : "acceptable only";
}

bool IsWorseThanGood(ConditionClass condition) {
  return condition == ConditionClass::kBad || condition == ConditionClass::kAcceptable;
}

std::string DistanceReason(ConditionClass condition, float distance_m,
                           const ThermalDistanceOptions& limits) {
  const std::string rule = fmt::format("{:.2f} to {:.2f} m is good, up to {:.2f} m acceptable",
                                       limits.min_m(), limits.good_m(), limits.max_m());
  if (std::isnan(distance_m)) return fmt::format("distance {}: {}", VerdictOf(condition), rule);
  return fmt::format("distance {}: measured from {:.2f} m; {}", VerdictOf(condition), distance_m,
                     rule);
}

std::string AngleReason(ConditionClass condition, float angle_deg,
                        const ThermalAngleOptions& limits) {
  const std::string rule = fmt::format("{:.0f} to {:.0f} degrees are good, up to {:.0f} acceptable",
                                       limits.min_deg(), limits.good_deg(), limits.max_deg());
  if (std::isnan(angle_deg)) return fmt::format("angle {}: {}", VerdictOf(condition), rule);
  return fmt::format("angle {}: measured at {:.0f} degrees to the normal; {}", VerdictOf(condition),
                     angle_deg, rule);
}

void AddReasons(const PointMeasurement& measurement, float angle_deg, const ThermalOptions& limits,
                measuring::VoxelRecord& record) {
  const ThermalVoxel& voxel = measurement.voxel;
  if (!voxel.assessed()) {
    record.add_reasons("never measured: the thermal camera has not seen this place yet");
    return;
  }
  const float distance_m =
      measurement.conditions.empty() ? NAN : measurement.conditions.distance_m();
  if (IsWorseThanGood(voxel.distance_class()))
    record.add_reasons(DistanceReason(voxel.distance_class(), distance_m, limits.distance()));
  if (IsWorseThanGood(voxel.angle_class()))
    record.add_reasons(AngleReason(voxel.angle_class(), angle_deg, limits.angle()));
  if (IsWorseThanGood(voxel.motion_class())) {
    record.add_reasons(fmt::format("motion {}: the image was smeared while the rig moved",
                                   VerdictOf(voxel.motion_class())));
  }
  if (IsWorseThanGood(voxel.disagreement_class())) {
    record.add_reasons(
        fmt::format("disagreement {}: measurements under good conditions differ, by a reflection "
                    "or because it changed",
                    VerdictOf(voxel.disagreement_class())));
  }
  if (!voxel.measured()) {
    record.add_reasons(
        "no temperature is kept: it was measured under bad conditions only, or did not stand the "
        "review");
  }
}

void AddConditions(const PointMeasurement& measurement, float angle_deg,
                   measuring::VoxelRecord& record) {
  const ConditionRecord& conditions = measurement.conditions;
  if (conditions.empty()) return;
  record.set_distance_m(conditions.distance_m());
  record.set_angle_deg(angle_deg);
  if (!std::isnan(conditions.age_s())) record.set_nuc_age_s(conditions.age_s());
  record.set_nuc_epoch(conditions.epoch);
  record.set_observations(conditions.good_count);
  if (conditions.good_count > 1) record.set_disagreement_k(measurement.disagreement.range_k());
}

void AddTemperatures(const PointMeasurement& measurement, float angle_deg,
                     const Interpretation& interpretation, measuring::VoxelRecord& record) {
  if (!measurement.voxel.measured()) return;
  const float apparent = measurement.voxel.celsius();
  record.set_apparent_celsius(apparent);
  const float object = interpretation.ObjectCelsius(0, apparent, angle_deg);
  if (!std::isnan(object)) record.set_object_celsius(object);
  if (std::isnan(measurement.sigma_k)) return;
  record.set_sigma_k(measurement.sigma_k);
  const float sigma = interpretation.ObjectSigma(0, apparent, measurement.sigma_k, angle_deg);
  if (!std::isnan(sigma)) record.set_object_sigma_k(sigma);
}

}  // namespace

std::string QualityName(MeasurementQuality quality) {
  constexpr const char* kNames[] = {"good", "acceptable", "bad", "never"};
  return kNames[static_cast<std::size_t>(quality)];
}

measuring::Vector3 ToMessage(const Eigen::Vector3f& vector) {
  measuring::Vector3 message;
  message.set_x(vector.x());
  message.set_y(vector.y());
  message.set_z(vector.z());
  return message;
}

measuring::VoxelRecord RecordAt(const TsdfVolume& tsdf, const ThermalVolume& thermal,
                                const ProbeHit& hit, const Interpretation& interpretation,
                                const AssessmentLimits& limits) {
  measuring::VoxelRecord record;
  record.set_hit(true);
  record.mutable_point()->set_x(hit.point.x());
  record.mutable_point()->set_y(hit.point.y());
  record.mutable_point()->set_z(hit.point.z());
  *record.mutable_normal() = ToMessage(hit.normal);
  const PointMeasurement measurement = FaceMeasurementAt(tsdf, thermal, hit.point, hit.normal);
  const float angle_deg = measurement.conditions.empty()
                              ? NAN
                              : AngleToNormalDeg(measurement.conditions.direction, hit.normal);
  AddTemperatures(measurement, angle_deg, interpretation, record);
  AddConditions(measurement, angle_deg, record);
  const GridIndex voxel = tsdf.grid().ToVoxel(hit.point).array().round().cast<int>();
  record.set_depth_weight(tsdf.VoxelAt(voxel).weight());
  if (measurement.voxel.assessed()) {
    record.set_distance_class(ToCondition(measurement.voxel.distance_class()));
    record.set_angle_class(ToCondition(measurement.voxel.angle_class()));
    record.set_motion_class(ToCondition(measurement.voxel.motion_class()));
    record.set_disagreement_class(ToCondition(measurement.voxel.disagreement_class()));
  }
  record.set_quality(QualityName(measurement.voxel.quality()));
  AddReasons(measurement, angle_deg, limits.limits, record);
  return record;
}

}  // namespace isotherm
