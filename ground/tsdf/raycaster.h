#pragma once

#include <optional>

#include "common/concurrency/thread_pool.h"
#include "common/geometry/camera.h"
#include "ground/tracker/surface_maps.h"
#include "ground/tsdf/tsdf_volume.h"

namespace isotherm {

/// Vertex and normal maps of the model in `world`, seen by `camera` (its distortion is ignored) from
/// `T_world_camera` (algorithm 3). The zero crossing is found between trilinearly interpolated distances and the
/// normal is their interpolated gradient. Voxels lighter than `min_weight` do not count as observed.
void Raycast(const TsdfVolume& volume, const CameraModel& camera, const RigidTransform& T_world_camera,
             float min_weight, ThreadPool& pool, SurfaceMaps& maps);

/// Truncated distance (in truncation distances) interpolated at voxel coordinates; nullopt unless all eight
/// voxels around were observed.
std::optional<float> InterpolateTsdf(const TsdfVolume& volume, const Eigen::Vector3f& p_voxel, float min_weight);

}  // namespace isotherm
