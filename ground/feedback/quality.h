#pragma once

#include <initializer_list>

#include "ground/renderer/view_maps.h"
#include "ground/thermal/thermal_volume.h"

namespace isotherm {

/// How well a voxel was measured, as QualityAt() says of a pixel. "Measured well" is kGood
/// everywhere in this folder.
inline MeasurementQuality QualityOf(ThermalVoxel voxel) {
  if (!voxel.assessed()) return MeasurementQuality::kNever;
  MeasurementQuality worst = MeasurementQuality::kGood;
  for (const ConditionClass c :
       {voxel.distance_class(), voxel.angle_class(), voxel.motion_class()}) {
    if (c == ConditionClass::kBad) return MeasurementQuality::kBad;
    if (c == ConditionClass::kAcceptable) worst = MeasurementQuality::kAcceptable;
  }
  return worst;
}

}  // namespace isotherm
