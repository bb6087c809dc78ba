#include "ground/mesh/face_measurement.h"

#include "ground/thermal/condition_record.h"
#include "ground/thermal/temperature_review.h"

namespace isotherm {

PointMeasurement FaceMeasurementAt(const TsdfVolume& tsdf, const ThermalVolume& thermal,
                                   const Eigen::Vector3d& p_map, const Eigen::Vector3f& normal) {
  const PointMeasurement found = MeasurementAt(tsdf, thermal, p_map);
  if (!found.voxel.assessed()) return {};
  if (!found.conditions.empty() && !BelongsToFace(found.conditions, normal, 0.0F)) return {};
  return found;
}

CloudPoint MeasuredPoint(const TsdfVolume& tsdf, const ThermalVolume& thermal,
                         const Eigen::Vector3d& p_world, const Eigen::Vector3f& normal) {
  CloudPoint point;
  point.position_m = p_world.cast<float>();
  point.normal = normal;
  const PointMeasurement measurement = FaceMeasurementAt(tsdf, thermal, p_world, normal);
  const ThermalVoxel& voxel = measurement.voxel;
  const ConditionRecord& conditions = measurement.conditions;
  if (!voxel.assessed()) return point;
  point.celsius = voxel.celsius();
  point.distance_class = static_cast<std::uint8_t>(voxel.distance_class());
  point.angle_class = static_cast<std::uint8_t>(voxel.angle_class());
  point.motion_class = static_cast<std::uint8_t>(voxel.motion_class());
  point.disagreement_class = static_cast<std::uint8_t>(voxel.disagreement_class());
  if (conditions.empty()) return point;
  point.sigma_k = measurement.sigma_k;
  point.nuc_epoch = conditions.epoch;
  point.good_count = static_cast<std::uint8_t>(conditions.good_count);
  point.nuc_age_s = conditions.age_s();
  point.measured_distance_m = conditions.distance_m();
  point.measured_angle_deg = AngleToNormalDeg(conditions.direction, normal);
  return point;
}

}  // namespace isotherm
