#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "common/concurrency/thread_pool.h"
#include "common/geometry/camera.h"
#include "common/geometry/rigid_transform.h"
#include "ground/surface/surface_maps.h"
#include "ground/tsdf/tsdf_volume.h"
#include "ground/tsdf/visible_blocks.h"

namespace isotherm {

class RaycastOptions;

Status Validate(const RaycastOptions& options);

/// Bounds of the depth at which rays can end, per tile of the image: blocks that may hold voxels
/// behind the surface are projected as the boxes around them. Thread-compatible.
class RangeMap {
 public:
  void Compute(const TsdfVolume& volume, const CameraModel& camera,
               const RigidTransform& T_map_camera);

  int tiles_x() const { return tiles_x_; }
  int tiles_y() const { return tiles_y_; }
  /// Depth along z in voxels; far <= near where no block projects.
  float near_vox(int x, int y) const { return near_vox_[Index(x, y)]; }
  float far_vox(int x, int y) const { return far_vox_[Index(x, y)]; }

 private:
  std::size_t Index(int x, int y) const { return static_cast<std::size_t>(y * tiles_x_ + x); }

  VisibleBlocks visible_;
  int tiles_x_ = 0;
  int tiles_y_ = 0;
  std::vector<float> near_vox_, far_vox_;
};

/// The camera whose maps UpsampleRow makes whole: every second pixel each way, and one beyond the
/// last.
CameraModel EverySecondPixel(CameraModel camera);

/// Tells how exactly a ray's end is to be found.
enum class RaycastPrecision : std::uint8_t {
  kSurface,     ///< To a small fraction of a voxel: for tracking and results.
  kVisibility,  ///< To about a tenth of a voxel, a fifth faster: for what hides what.
};

/// Vertex and normal maps of the model (algorithm 3). The change of sign is found between nearest
/// voxels, then refined by Newton steps in the trilinearly interpolated distance, whose gradient is
/// the normal. Keeps scratch memory. Thread-compatible.
class Raycaster {
 public:
  explicit Raycaster(RaycastPrecision precision = RaycastPrecision::kSurface)
      : precision_(precision) {}

  /// Maps in `map`, seen by `camera` (its distortion is ignored) from `T_map_camera`. Voxels
  /// lighter than `min_weight` do not count as observed.
  void Cast(const TsdfVolume& volume, const CameraModel& camera, const RigidTransform& T_map_camera,
            float min_weight, ThreadPool& pool, SurfaceMaps& maps);

 private:
  const RaycastPrecision precision_;
  RangeMap range_;
};

/// Truncated distance (in truncation distances) interpolated at voxel coordinates; nullopt unless
/// all eight voxels around were observed.
std::optional<float> InterpolateTsdf(const TsdfVolume& volume, const Eigen::Vector3f& p_voxel,
                                     float min_weight);

}  // namespace isotherm
