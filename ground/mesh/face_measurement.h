#pragma once

#include "ground/mesh/surface.h"
#include "ground/thermal/thermal_volume.h"
#include "ground/tsdf/tsdf_volume.h"

namespace isotherm {

/// The measurement that belongs to a point of the surface with this normal (algorithm 10, lines
/// 4-9). Unmeasured if there is none, or if it is another face's: beside edges, the nearest voxel
/// may be that.
PointMeasurement FaceMeasurementAt(const TsdfVolume& tsdf, const ThermalVolume& thermal,
                                   const Eigen::Vector3d& p_map, const Eigen::Vector3f& normal);

/// The same as a point of the extended cloud.
CloudPoint MeasuredPoint(const TsdfVolume& tsdf, const ThermalVolume& thermal,
                         const Eigen::Vector3d& p_map, const Eigen::Vector3f& normal);

}  // namespace isotherm
