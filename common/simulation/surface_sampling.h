#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <vector>

#include "common/base/status.h"
#include "common/geometry/camera.h"
#include "common/geometry/rigid_transform.h"
#include "common/simulation/scene.h"

namespace isotherm {

/// A point of the true surface and how often it was seen.
struct SurfaceSample {
  SurfacePoint point;
  std::uint16_t seen_depth = 0;    ///< Poses from which the depth camera sees it.
  std::uint16_t seen_thermal = 0;  ///< The same for the thermal camera.
};

/// Points on all surfaces, about `spacing_m` apart, without those that lie inside or against
/// another part. Shapes without thickness give their +z side.
std::vector<SurfaceSample> SampleSurface(const Scene& scene, double spacing_m);

/// Adds 1 to the counts of the points that `camera` sees from `T_world_camera`: in the image, in
/// front of everything else, facing the camera, within `max_distance_m`.
enum class SeenBy { kDepth, kThermal };
void CountSeen(const Scene& scene, const CameraModel& camera, const RigidTransform& T_world_camera,
               double max_distance_m, SeenBy seen_by, std::span<SurfaceSample> samples);

/// Binary PLY: x y z nx ny nz scalar_temperature (true, °C) primitive seen seen_thermal.
Status WriteSurfacePly(const std::filesystem::path& path, std::span<const SurfaceSample> samples);

}  // namespace isotherm
