#include "ground/tsdf/raycaster.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "ground/ground_options.pb.h"
#include "ground/tsdf/raycast_kernel.h"

namespace isotherm {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

/// Looks voxels up with the block of the last look-up at hand.
class VoxelCursor {
 public:
  VoxelCursor(const TsdfVolume& volume, std::int32_t min_weight_code)
      : volume_(volume), min_weight_(static_cast<std::uint32_t>(min_weight_code)) {}

  /// First voxel of the block that holds `voxel`; null if there is none.
  const TsdfVoxel* Block(const GridIndex& voxel) {
    const GridIndex block(voxel.x() >> 3, voxel.y() >> 3, voxel.z() >> 3);
    if (block != block_) {
      block_ = block;
      const std::int32_t index = volume_.Find(block);
      voxels_ = index == TsdfVolume::kNoBlock ? nullptr : volume_.voxels(index).data();
    }
    return voxels_;
  }

  static std::size_t Local(const GridIndex& voxel) {
    return static_cast<std::size_t>((voxel.x() & 7) | ((voxel.y() & 7) << 3) |
                                    ((voxel.z() & 7) << 6));
  }

  bool Observed(TsdfVoxel voxel) const { return (voxel.bits & 0xFFFFU) >= min_weight_; }

  /// NaN where nothing was observed.
  float Tsdf(const GridIndex& voxel) {
    const TsdfVoxel* block = Block(voxel);
    if (block == nullptr) return kNan;
    const TsdfVoxel v = block[Local(voxel)];
    return Observed(v) ? v.tsdf() : kNan;
  }

  /// NaN unless all eight voxels around were observed.
  float Interpolate(const Eigen::Vector3f& p) {
    const Eigen::Vector3f lower = p.array().floor();
    const Eigen::Vector3f f = p - lower;
    const GridIndex i = lower.cast<int>();
    std::array<float, 8> d;
    if ((i.x() & 7) != 7 && (i.y() & 7) != 7 && (i.z() & 7) != 7) {
      const TsdfVoxel* block = Block(i);
      if (block == nullptr) return kNan;
      const std::size_t local = Local(i);
      for (std::size_t k = 0; k < 8; ++k) {
        const TsdfVoxel v = block[local + (k & 1) + ((k >> 1) & 1) * 8 + (k >> 2) * 64];
        if (!Observed(v)) return kNan;
        d[k] = v.tsdf();
      }
    } else {
      for (int k = 0; k < 8; ++k) d[k] = Tsdf(i + GridIndex(k & 1, (k >> 1) & 1, k >> 2));
    }
    const float x00 = d[0] + f.x() * (d[1] - d[0]);
    const float x10 = d[2] + f.x() * (d[3] - d[2]);
    const float x01 = d[4] + f.x() * (d[5] - d[4]);
    const float x11 = d[6] + f.x() * (d[7] - d[6]);
    const float y0 = x00 + f.y() * (x10 - x00);
    const float y1 = x01 + f.y() * (x11 - x01);
    return y0 + f.z() * (y1 - y0);
  }

 private:
  const TsdfVolume& volume_;
  const std::uint32_t min_weight_;
  GridIndex block_ = GridIndex::Constant(std::numeric_limits<int>::min());
  const TsdfVoxel* voxels_ = nullptr;
};

/// Rounds up, and never to nothing: weight 0 means never observed.
std::int32_t MinWeightCode(float min_weight) {
  return std::max(1, static_cast<std::int32_t>(std::ceil(min_weight * TsdfVoxel::kWeightScale)));
}

}  // namespace

std::optional<float> InterpolateTsdf(const TsdfVolume& volume, const Eigen::Vector3f& p_voxel,
                                     float min_weight) {
  VoxelCursor cursor(volume, MinWeightCode(min_weight));
  const float value = cursor.Interpolate(p_voxel);
  return std::isnan(value) ? std::nullopt : std::optional<float>(value);
}

Status Validate(const RaycastOptions& o) {
  if (!(o.min_weight() >= 0.0 && o.min_weight() <= 1000.0) || o.halvings() < 0 ||
      o.halvings() > 2) {
    return InvalidArgument("raycast: min_weight must be 0..1000 observations and halvings 0..2");
  }
  return OkStatus();
}

void RangeMap::Compute(const TsdfVolume& volume, const CameraModel& camera,
                       const RigidTransform& T_world_camera) {
  tiles_x_ = (camera.width + kRaycastTile - 1) / kRaycastTile;
  tiles_y_ = (camera.height + kRaycastTile - 1) / kRaycastTile;
  const auto count = static_cast<std::size_t>(tiles_x_) * static_cast<std::size_t>(tiles_y_);
  near_vox_.assign(count, std::numeric_limits<float>::max());
  far_vox_.assign(count, 0.0F);
  const RigidTransform T_camera_world = T_world_camera.inverse();
  const VoxelGrid& grid = volume.grid();
  // Block coordinates to camera coordinates in voxels: p = A b + t.
  const Eigen::Matrix3f A = (T_camera_world.linear() * kBlockSide).cast<float>();
  const Eigen::Vector3f t =
      (T_camera_world * (grid.min_m + Eigen::Vector3d::Constant(0.5 * grid.block_size_m())) /
       grid.voxel_size_m)
          .cast<float>();
  constexpr float kRadius = 0.5F * 1.7320508F * kBlockSide;
  const auto fx = static_cast<float>(camera.fx);
  const auto fy = static_cast<float>(camera.fy);
  const auto cx = static_cast<float>(camera.cx) + 0.5F;
  const auto cy = static_cast<float>(camera.cy) + 0.5F;
  for (std::int32_t block = 0; block < volume.block_count(); ++block) {
    const Eigen::Vector3f p = A * volume.block_coordinates(block).cast<float>() + t;
    const float near = std::max(p.z() - kRadius, 0.0F);
    const float far = p.z() + kRadius;
    if (far <= 0.0F) continue;
    int x0 = 0, y0 = 0, x1 = tiles_x_ - 1, y1 = tiles_y_ - 1;
    if (near > kRadius) {
      // The sphere around the block projects into this rectangle (the nearest depth gives the
      // largest extent).
      const float inverse = 1.0F / near;
      const float extent = kRadius * 1.5F * inverse;
      const float u = fx * p.x() / p.z() + cx;
      const float v = fy * p.y() / p.z() + cy;
      const float du = fx * extent;
      const float dv = fy * extent;
      if (u + du < 0.0F || v + dv < 0.0F || u - du >= static_cast<float>(camera.width) ||
          v - dv >= static_cast<float>(camera.height)) {
        continue;
      }
      x0 = std::max(0, static_cast<int>(u - du) / kRaycastTile);
      y0 = std::max(0, static_cast<int>(v - dv) / kRaycastTile);
      x1 = std::min(x1, static_cast<int>(u + du) / kRaycastTile);
      y1 = std::min(y1, static_cast<int>(v + dv) / kRaycastTile);
    }
    for (int y = y0; y <= y1; ++y) {
      for (int x = x0; x <= x1; ++x) {
        const auto tile = static_cast<std::size_t>(y * tiles_x_ + x);
        near_vox_[tile] = std::min(near_vox_[tile], near);
        far_vox_[tile] = std::max(far_vox_[tile], far);
      }
    }
  }
}

void Raycaster::Cast(const TsdfVolume& volume, const CameraModel& camera,
                     const RigidTransform& T_world_camera, float min_weight, ThreadPool& pool,
                     SurfaceMaps& maps) {
  maps.Resize(camera.width, camera.height);
  if (volume.block_count() == 0) {
    for (Image<float>* plane : {&maps.vx, &maps.vy, &maps.vz, &maps.nx, &maps.ny, &maps.nz})
      plane->Fill(kNan);
    return;
  }
  range_.Compute(volume, camera, T_world_camera);
  const VoxelGrid& grid = volume.grid();
  RaycastKernelArgs args{};
  args.table = volume.table().data();
  args.voxels = reinterpret_cast<const std::int32_t*>(volume.base());
  args.blocks_x = grid.blocks.x();
  args.blocks_y = grid.blocks.y();
  args.blocks_z = grid.blocks.z();
  args.min_weight_code = MinWeightCode(min_weight);
  args.truncation_vox = static_cast<float>(volume.truncation_distance_m() / grid.voxel_size_m);
  const Eigen::Vector3f origin = grid.ToVoxel(T_world_camera.translation()).cast<float>();
  const Eigen::Vector3f world_origin = T_world_camera.translation().cast<float>();
  const Eigen::Matrix<float, 3, 3, Eigen::RowMajor> R = T_world_camera.linear().cast<float>();
  std::copy_n(origin.data(), 3, args.origin);
  std::copy_n(world_origin.data(), 3, args.world_origin);
  std::copy_n(R.data(), 9, args.R);
  args.fx = static_cast<float>(camera.fx);
  args.fy = static_cast<float>(camera.fy);
  args.cx = static_cast<float>(camera.cx);
  args.cy = static_cast<float>(camera.cy);
  args.voxel_m = static_cast<float>(grid.voxel_size_m);
  args.near_vox = range_.near_vox();
  args.far_vox = range_.far_vox();
  args.tiles_per_row = range_.tiles_x();
  pool.ParallelFor(range_.tiles_y(), [&](int task) {
    const int end = std::min(camera.height, (task + 1) * kRaycastTile);
    for (int y = task * kRaycastTile; y < end; ++y) RaycastRow(args, y, maps);
  });
}

}  // namespace isotherm
