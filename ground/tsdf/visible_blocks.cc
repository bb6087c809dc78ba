#include "ground/tsdf/visible_blocks.h"

#include <algorithm>

#include "ground/tsdf/culling_kernel.h"

namespace isotherm {

std::span<const std::int32_t> VisibleBlocks::Find(const TsdfVolume& volume,
                                                  const CameraModel& camera,
                                                  const RigidTransform& T_map_camera) {
  // Planes of the pyramid through the image's borders, inward normals, camera coordinates.
  const double left = (-0.5 - camera.cx) / camera.fx;
  const double right = (camera.width - 0.5 - camera.cx) / camera.fx;
  const double top = (-0.5 - camera.cy) / camera.fy;
  const double bottom = (camera.height - 0.5 - camera.cy) / camera.fy;
  const Eigen::Vector3d normals[kFrustumPlanes] = {
      {1.0, 0.0, -left}, {-1.0, 0.0, right}, {0.0, 1.0, -top}, {0.0, -1.0, bottom}, {0, 0, 1}};
  const VoxelGrid& grid = volume.grid();
  const RigidTransform T_camera_map = T_map_camera.inverse();
  const Eigen::Matrix3d A = T_camera_map.linear() * grid.block_size_m();
  const Eigen::Vector3d t =
      T_camera_map * (grid.min_m + Eigen::Vector3d::Constant(0.5 * grid.block_size_m()));
  float planes[kFrustumPlanes][4];
  for (int i = 0; i < kFrustumPlanes; ++i) {
    const Eigen::Vector3d n = normals[i].normalized();
    const Eigen::Vector3f slope = (A.transpose() * n).cast<float>();
    std::copy_n(slope.data(), 3, planes[i]);
    planes[i][3] = static_cast<float>(n.dot(t)) + BlockRadius(grid);
  }
  blocks_.resize(static_cast<std::size_t>(volume.block_count() + kCullingPadding));
  const std::int32_t found =
      CullBlocks(planes, volume.coordinates(), volume.block_count(), blocks_.data());
  return {blocks_.data(), static_cast<std::size_t>(found)};
}

}  // namespace isotherm
