#pragma once

#include <cstdint>

#include "ground/options/ground_options.pb.h"
#include "ground/thermal/measurement_conditions.h"
#include "ground/thermal/thermal_volume.h"
#include "ground/tsdf/tsdf_volume.h"

namespace isotherm {

/// Returns whether what was measured belongs to a surface with this unit normal: the surface that
/// was seen then had the same direction, and this one faces the camera at no more than an angle.
bool BelongsToFace(const ConditionRecord& record, const Eigen::Vector3f& normal, float min_cosine);

/// Assesses kept temperatures again by the surface as it is known now. A measurement's angle was
/// found from what the surface looked like then; of many noisy angles the kindest wins
/// (algorithm 6), so that steep faces and edges keep values that never were good. A temperature is
/// dropped if its voxel's surface turns out to have been seen at a bad angle, or turned away from
/// the surface that was seen: it belongs to another face. The final review also drops what lies
/// beside an edge to a face that was seen at a bad angle: the model rounds edges by a voxel or two,
/// and whose radiation a pixel there received is not known. Needs records; without, does nothing.
/// Thread-safe for different blocks (immutable).
class TemperatureReview {
 public:
  TemperatureReview(const ThermalOptions& options, const ThermalSensorModel& sensor);

  /// Returns how many temperatures of the block were dropped. What is dropped keeps its classes.
  std::int64_t Review(std::int32_t block, const TsdfVolume& tsdf, ThermalVolume& thermal,
                      bool is_final = false) const;

 private:
  bool IsBesideSteepFace(const ConditionRecord& record, const Eigen::Vector3f& normal,
                         const TsdfVolume& tsdf, const GridIndex& voxel) const;

  const ConditionLimits limits_;
  const bool keep_bad_;
};

}  // namespace isotherm
