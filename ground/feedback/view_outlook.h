#pragma once

#include <optional>

#include "common/concurrency/thread_pool.h"
#include "common/geometry/camera.h"
#include "common/geometry/rigid_transform.h"
#include "common/rig/rig.h"
#include "ground/feedback/seen_space.h"
#include "ground/feedback/tried_surface.h"
#include "ground/options/ground_options.pb.h"
#include "ground/surface/surface_maps.h"
#include "ground/thermal/thermal_fuser.h"
#include "ground/tsdf/raycaster.h"

namespace isotherm {

/// Says what a view would be good for.
struct Outlook {
  /// False where a camera would be inside or too close to something, or the depth camera would see
  /// too little to follow.
  bool is_possible = false;
  double gain_m2 = 0.0;  ///< Surface that it would measure well and that is not measured well yet.
  double unseen_m2 = 0.0;  ///< Surface that may be where it looks and the depth camera never did.
  double firmness = 0.0;   ///< Trackability::Firmness().
};

/// Tells what views of the model would be good for, by casting the model coarsely from there, and
/// remembers which surface several looks did not measure well. Thread-compatible.
class ViewAssessor {
 public:
  /// `rig` must have both cameras and their relative pose (CHECK). Voxels lighter than `min_weight`
  /// do not count as observed.
  ViewAssessor(const ThermalOptions& limits, const Rig& rig, float min_weight);

  Outlook LookFrom(const RigidTransform& T_map_depth, const TsdfVolume& tsdf,
                   const ThermalVolume& thermal, ThreadPool& pool);
  /// Takes that the depth camera looks from there into a scan volume with this grid.
  void NoteSeen(const RigidTransform& T_map_depth, const VoxelGrid& grid);
  /// Takes that the rig is at `T_map_depth` and hardly moves: what it sees under good conditions is
  /// measured well by now, or, after several times, never will be.
  void NoteLook(const RigidTransform& T_map_depth, const TsdfVolume& tsdf,
                const ThermalVolume& thermal, ThreadPool& pool);

  const ConditionLimits& limits() const { return limits_; }
  /// The depth camera measures nothing closer.
  double min_depth_m() const { return min_depth_m_; }
  const RigidTransform& T_thermal_depth() const { return T_thermal_depth_; }
  const TriedSurface& tried() const { return tried_; }

 private:
  /// Casts the model and calls `visit(p_map, n_map, area_m2)` for each ray that meets surface which
  /// both cameras see and of which a temperature would be good, with the area that the ray stands
  /// for. Returns what is known of the outlook without the gain.
  template <typename Visit>
  Outlook Cast(const RigidTransform& T_map_depth, const TsdfVolume& tsdf, ThreadPool& pool,
               const Visit& visit);
  bool IsDepthInView(const Eigen::Vector3d& p_depth) const;
  bool WouldBeGood(double distance_m, double cosine) const;
  /// The surface that a ray which meets none may stand for, square metres: what was never looked at
  /// there, half-way through the good distances.
  double UnseenArea(const RigidTransform& T_map_thermal, int x, int y) const;

  const ConditionLimits limits_;
  const float min_weight_;
  const double min_depth_m_;
  const CameraModel depth_camera_;
  const CameraModel thermal_camera_;  ///< The camera of the coarse cast.
  const RigidTransform T_thermal_depth_;
  Raycaster raycaster_{RaycastPrecision::kVisibility};
  SurfaceMaps maps_;
  TriedSurface tried_;
  std::optional<SeenSpace> seen_;
};

}  // namespace isotherm
