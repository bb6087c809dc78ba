#pragma once

#include "common/concurrency/thread_pool.h"
#include "common/geometry/camera.h"
#include "common/geometry/rigid_transform.h"
#include "ground/surface/surface_maps.h"
#include "ground/tsdf/raycaster.h"
#include "ground/tsdf/tsdf_volume.h"

namespace isotherm {

class RaycastOptions;

/// Casts the view of the model that frames are tracked against. With RaycastOptions' `interpolate`,
/// a quarter of the rays is cast, and the pixels between are interpolated where rays around meet
/// one surface. Keeps scratch memory. Thread-compatible.
class ViewRaycaster {
 public:
  explicit ViewRaycaster(const RaycastOptions& options);

  /// Maps in `map`, seen by `camera` (its distortion is ignored) from `T_map_camera`.
  void Cast(const TsdfVolume& volume, const CameraModel& camera, const RigidTransform& T_map_camera,
            ThreadPool& pool, SurfaceMaps& maps);

 private:
  const float min_weight_;
  const bool interpolates_;
  Raycaster raycaster_;
  SurfaceMaps coarse_;
};

}  // namespace isotherm
