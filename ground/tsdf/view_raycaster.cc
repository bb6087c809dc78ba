#include "ground/tsdf/view_raycaster.h"

#include "ground/options/ground_options.pb.h"
#include "ground/surface/upsample_kernel.h"

namespace isotherm {
namespace {

/// Rows of a view: 30 tasks for the 240 of the usual one. Not tuned.
constexpr int kRowsPerTask = 8;

}  // namespace

ViewRaycaster::ViewRaycaster(const RaycastOptions& options)
    : min_weight_(static_cast<float>(options.expert().min_weight())),
      interpolates_(options.expert().interpolate()) {}

void ViewRaycaster::Cast(const TsdfVolume& volume, const CameraModel& camera,
                         const RigidTransform& T_map_camera, ThreadPool& pool, SurfaceMaps& maps) {
  if (!interpolates_) {
    raycaster_.Cast(volume, camera, T_map_camera, min_weight_, pool, maps);
    return;
  }
  raycaster_.Cast(volume, EverySecondPixel(camera), T_map_camera, min_weight_, pool, coarse_);
  UpsampleRowArgs args{};
  args.coarse = &coarse_;
  // Steps and folds that are smaller are bridged by a ramp, at a right-angled fold by up to
  // half of this. Smaller: at 2 m the noise of normals, times the distance of the rays, passes
  // for a step; with a quarter of a voxel the rig was lost. Larger: it is tracked against more that
  // is not there. From a quarter of a voxel to the four voxels that this is by default,
  // trajectories are equally accurate.
  args.max_plane_distance_m = static_cast<float>(volume.truncation_distance_m());
  maps.Resize(camera.width, camera.height);
  pool.ParallelForRows(camera.height, kRowsPerTask,
                       [&](int y) { UpsampleRow(args, y, maps, nullptr); });
}

}  // namespace isotherm
