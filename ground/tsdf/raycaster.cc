#include "ground/tsdf/raycaster.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "ground/options/ground_options.pb.h"
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
    const GridIndex block = voxel.unaryExpr([](int v) { return v >> BlockLayout::kSideBits; });
    if (block != block_) {
      block_ = block;
      const std::int32_t index = volume_.Find(block);
      voxels_ = index == TsdfVolume::kNoBlock ? nullptr : volume_.voxels(index).data();
    }
    return voxels_;
  }

  static std::size_t Local(const GridIndex& voxel) {
    return static_cast<std::size_t>(BlockLayout::Element(voxel.x(), voxel.y(), voxel.z()));
  }

  bool Observed(TsdfVoxel voxel) const { return TsdfLayout::WeightCode(voxel.bits) >= min_weight_; }

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
    const auto next_in_block = [](int v) {
      return (v & BlockLayout::kSideMask) != BlockLayout::kSideMask;
    };
    if (next_in_block(i.x()) && next_in_block(i.y()) && next_in_block(i.z())) {
      const TsdfVoxel* block = Block(i);
      if (block == nullptr) return kNan;
      const std::size_t local = Local(i);
      for (std::size_t k = 0; k < 8; ++k) {
        const TsdfVoxel v = block[local + (k & 1) + ((k >> 1) & 1) * kBlockSide +
                                  (k >> 2) * BlockLayout::kLayerVoxels];
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

/// No surface in a tile.
void ClearTile(int tile_x, int tile_y, SurfaceMaps& maps) {
  const int columns = std::min(kRaycastTile, maps.width() - tile_x);
  const int end = std::min(tile_y + kRaycastTile, maps.height());
  for (Image<float>* plane : {&maps.vx, &maps.vy, &maps.vz, &maps.nx, &maps.ny, &maps.nz}) {
    for (int y = tile_y; y < end; ++y) std::fill_n(plane->Row(y).data() + tile_x, columns, kNan);
  }
}

}  // namespace

std::optional<float> InterpolateTsdf(const TsdfVolume& volume, const Eigen::Vector3f& p_voxel,
                                     float min_weight) {
  VoxelCursor cursor(volume, MinWeightCode(min_weight));
  const float value = cursor.Interpolate(p_voxel);
  return std::isnan(value) ? std::nullopt : std::optional<float>(value);
}

Status Validate(const RaycastOptions& o) {
  if (!(o.expert().min_weight() >= 0.0 && o.expert().min_weight() <= 1000.0) ||
      o.expert().halvings() < 0 || o.expert().halvings() > 2) {
    return InvalidArgument(
        "raycast.expert: min_weight must be 0..1000 observations and halvings 0..2");
  }
  return OkStatus();
}

CameraModel EverySecondPixel(CameraModel camera) {
  camera.width = camera.width / 2 + 1;
  camera.height = camera.height / 2 + 1;
  for (double* parameter : {&camera.fx, &camera.fy, &camera.cx, &camera.cy}) *parameter *= 0.5;
  return camera;
}

void RangeMap::Compute(const TsdfVolume& volume, const CameraModel& camera,
                       const RigidTransform& T_map_camera) {
  tiles_x_ = (camera.width + kRaycastTile - 1) / kRaycastTile;
  tiles_y_ = (camera.height + kRaycastTile - 1) / kRaycastTile;
  const auto count = static_cast<std::size_t>(tiles_x_) * static_cast<std::size_t>(tiles_y_);
  near_vox_.assign(count, std::numeric_limits<float>::max());
  far_vox_.assign(count, 0.0F);
  const VoxelGrid& grid = volume.grid();
  const BlockToCamera to_camera(grid, T_map_camera.inverse());
  const Eigen::Vector3f half = to_camera.HalfExtent();
  const auto inverse_voxel = static_cast<float>(1.0 / grid.voxel_size_m);
  const auto fx = static_cast<float>(camera.fx);
  const auto fy = static_cast<float>(camera.fy);
  const auto cx = static_cast<float>(camera.cx) + 0.5F;
  const auto cy = static_cast<float>(camera.cy) + 0.5F;
  const auto tile_of = [](float pixel, int tiles) { return TileOf(pixel, kRaycastTile, tiles); };
  // A ray ends where it comes from an observed voxel before the surface into one behind it: start
  // early enough to meet the former.
  constexpr float kLeadVox = 1.5F;
  for (const std::int32_t block : visible_.Find(volume, camera, T_map_camera)) {
    if (!volume.may_end_rays(block)) continue;
    const Eigen::Vector3f p = to_camera.Centre(volume.block_coordinates(block));
    const float near = p.z() - half.z();
    const float near_vox = std::max(near * inverse_voxel - kLeadVox, 0.0F);
    const float far_vox = (p.z() + half.z()) * inverse_voxel;
    int x0 = 0, y0 = 0, x1 = tiles_x_ - 1, y1 = tiles_y_ - 1;
    if (near > half.z()) {
      // Of the box around the block, the face nearer to the image's centre spreads least.
      const float inverse_near = 1.0F / near;
      const float inverse_far = 1.0F / (p.z() + half.z());
      const auto project = [&](float low, float high, float f, float c, int tiles, int& first,
                               int& last) {
        first = tile_of(f * low * (low < 0.0F ? inverse_near : inverse_far) + c, tiles);
        last = tile_of(f * high * (high > 0.0F ? inverse_near : inverse_far) + c, tiles);
      };
      project(p.x() - half.x(), p.x() + half.x(), fx, cx, tiles_x_, x0, x1);
      project(p.y() - half.y(), p.y() + half.y(), fy, cy, tiles_y_, y0, y1);
    }
    for (int y = y0; y <= y1; ++y) {
      for (int x = x0; x <= x1; ++x) {
        const auto tile = static_cast<std::size_t>(y * tiles_x_ + x);
        near_vox_[tile] = std::min(near_vox_[tile], near_vox);
        far_vox_[tile] = std::max(far_vox_[tile], far_vox);
      }
    }
  }
}

void Raycaster::Cast(const TsdfVolume& volume, const CameraModel& camera,
                     const RigidTransform& T_map_camera, float min_weight, ThreadPool& pool,
                     SurfaceMaps& maps) {
  maps.Resize(camera.width, camera.height);
  if (volume.block_count() == 0) {
    for (Image<float>* plane : {&maps.vx, &maps.vy, &maps.vz, &maps.nx, &maps.ny, &maps.nz})
      plane->Fill(kNan);
    return;
  }
  range_.Compute(volume, camera, T_map_camera);
  const VoxelGrid& grid = volume.grid();
  RaycastKernelArgs args{};
  args.table = volume.table().data();
  args.voxels = reinterpret_cast<const std::int32_t*>(volume.base());
  args.stride_y = volume.table_stride_y();
  args.stride_z = volume.table_stride_z();
  args.low = 0.5F * kBlockSide;
  for (int axis = 0; axis < 3; ++axis) {
    args.last[axis] = kBlockSide * (grid.blocks[axis] + 2) - 1;
    args.high[axis] = static_cast<float>(args.last[axis]) - args.low;
  }
  args.min_weight_code = MinWeightCode(min_weight);
  const bool exact = precision_ == RaycastPrecision::kSurface;
  args.max_refinements = exact ? 4 : 1;
  args.max_last_step_vox = exact ? 0.5F : 1.5F;
  args.truncation_vox = static_cast<float>(volume.truncation_distance_m() / grid.voxel_size_m);
  const Eigen::Vector3f origin =
      (grid.ToVoxel(T_map_camera.translation()) + Eigen::Vector3d::Constant(kBlockSide))
          .cast<float>();
  const Eigen::Vector3f map_origin = T_map_camera.translation().cast<float>();
  const Eigen::Matrix<float, 3, 3, Eigen::RowMajor> R = T_map_camera.linear().cast<float>();
  std::copy_n(origin.data(), 3, args.origin);
  std::copy_n(map_origin.data(), 3, args.map_origin);
  std::copy_n(R.data(), 9, args.R);
  args.fx = static_cast<float>(camera.fx);
  args.fy = static_cast<float>(camera.fy);
  args.cx = static_cast<float>(camera.cx);
  args.cy = static_cast<float>(camera.cy);
  args.voxel_m = static_cast<float>(grid.voxel_size_m);
  pool.ParallelFor(range_.tiles_y(), [&](int y) {
    for (int x = 0; x < range_.tiles_x(); ++x) {
      if (!(range_.far_vox(x, y) > range_.near_vox(x, y))) {
        ClearTile(x * kRaycastTile, y * kRaycastTile, maps);
        continue;
      }
      RaycastTile(args, x * kRaycastTile, y * kRaycastTile, range_.near_vox(x, y),
                  range_.far_vox(x, y), maps);
    }
  });
}

}  // namespace isotherm
