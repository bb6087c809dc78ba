#pragma once

#include "common/concurrency/thread_pool.h"
#include "common/geometry/rigid_transform.h"
#include "ground/thermal/thermal_volume.h"
#include "ground/tsdf/tsdf_volume.h"

namespace isotherm {

/// A volume and where it is in another's coordinates.
struct PlacedVolume {
  const TsdfVolume& tsdf;
  const ThermalVolume& thermal;
  RigidTransform T_target_source;
};

/// Adds what one volume knows to another of the same voxel size. Distances: the mean weighted by
/// the observations of both, the source's interpolated (trilinear, where all eight neighbours were
/// observed). Temperatures: of the nearest voxel, kept only where they were measured under better
/// conditions (algorithm 6); never averaged. The part outside the target's grid is left out, and
/// what is beyond its memory is counted by the target. False if there is no room for temperatures
/// on the disk to spill to: distances only.
bool MergeVolume(const PlacedVolume& source, float max_weight, ThreadPool& pool, TsdfVolume& tsdf,
                 ThermalVolume& thermal);

}  // namespace isotherm
