#include "ground/tsdf/tsdf_integrator.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "common/base/units.h"
#include "ground/surface/depth_preprocessor.h"

namespace isotherm {
namespace {

/// Side of the tiles whose largest depth is kept; a strip of tiles is one task.
constexpr int kTile = 16;

/// Every n-th row, and column, looks for missing blocks: at 1 m and 570 px focal length two pixels
/// are 3.5 mm apart.
constexpr int kAllocationStride = 2;

/// Four voxels are 8 mm at the default of 2 mm, beyond the noise and unevenness of a depth camera
/// up to 1 m (6 mm there, DepthSensorModel). Fewer: noise tears the surface; more: thin parts have
/// no inside, and more blocks are allocated.
constexpr double kTruncationVoxels = 4.0;
/// Larger bands are typing errors: millimetres instead of metres.
constexpr double kMaxTruncation_m = 1.0;

}  // namespace

double TruncationDistance(const TsdfOptions& o, const VolumeOptions& volume) {
  if (o.expert().truncation_distance_m() != 0.0) return o.expert().truncation_distance_m();
  return kTruncationVoxels * volume.voxel_size_m();
}

Status Validate(const TsdfOptions& o, const VolumeOptions& volume) {
  const double truncation_m = TruncationDistance(o, volume);
  // Four voxels are enough; that a voxel has a size at all is the volume's affair.
  if (o.expert().truncation_distance_m() != 0.0 && !(truncation_m >= 2.0 * volume.voxel_size_m())) {
    return InvalidArgument(fmt::format(
        "tsdf.expert.truncation_distance_m must be 0 (four voxels) or at least two voxels of "
        "volume.voxel_size_m ({:g} m), got {:g} m",
        2.0 * volume.voxel_size_m(), truncation_m));
  }
  if (!(truncation_m <= kMaxTruncation_m)) {
    return InvalidArgument(
        o.expert().truncation_distance_m() > 0.0
            ? fmt::format("tsdf.expert.truncation_distance_m must be at most {:g} m, got {:g} m",
                          kMaxTruncation_m, truncation_m)
            : fmt::format("volume.voxel_size_m must be at most {:g} m, got {:g} m",
                          kMaxTruncation_m / kTruncationVoxels, volume.voxel_size_m()));
  }
  if (!(o.expert().max_weight() >= 1.0 && o.expert().max_weight() <= 1000.0)) {
    return InvalidArgument(fmt::format(
        "tsdf.expert.max_weight must be 1..1000 observations, got {}", o.expert().max_weight()));
  }
  for (const double bound : {o.expert().min_step_m(), o.expert().max_step_m(),
                             o.expert().min_step_deg(), o.expert().max_step_deg()}) {
    if (!(bound >= 0.0))
      return InvalidArgument("tsdf.expert: step bounds must not be negative (0 turns one off)");
  }
  if ((o.expert().max_step_m() > 0.0 && o.expert().min_step_m() > o.expert().max_step_m()) ||
      (o.expert().max_step_deg() > 0.0 && o.expert().min_step_deg() > o.expert().max_step_deg())) {
    return InvalidArgument("tsdf.expert: min_step must not exceed max_step");
  }
  return OkStatus();
}

void TsdfIntegrator::MakeSamples(const PreparedDepth& depth, ThreadPool& pool) {
  const CameraF camera(depth.camera);
  const auto width = static_cast<std::size_t>(camera.width);
  samples_.resize(width * static_cast<std::size_t>(camera.height) + 1);
  // One sample beyond the image without depth, which kernels read where a voxel projects outside.
  samples_.back() = DepthSample{};
  farthest_m_.Resize((camera.width + kTile - 1) / kTile, (camera.height + kTile - 1) / kTile);
  const SurfaceMaps& maps = depth.maps[0];
  pool.ParallelFor(farthest_m_.height(), [&](int strip) {
    const std::span<float> farthest = farthest_m_.Row(strip);
    std::fill(farthest.begin(), farthest.end(), 0.0F);
    const int end = std::min(camera.height, (strip + 1) * kTile);
    for (int y = strip * kTile; y < end; ++y) {
      const std::span<const float> row = depth.depth_m.Row(y);
      MakeSampleRow(
          {row.data(), maps.nx.Row(y).data(), maps.ny.Row(y).data(), maps.nz.Row(y).data(),
           camera.width, camera.fx, camera.cx, (static_cast<float>(y) - camera.cy) / camera.fy,
           options_.expert().distance() == ALONG_RAY},
          samples_.data() + width * static_cast<std::size_t>(y));
      for (std::size_t tile = 0; tile < farthest.size(); ++tile) {
        const auto first = row.begin() + static_cast<std::ptrdiff_t>(tile * kTile);
        const auto last = std::min(first + kTile, row.end());
        for (auto z = first; z != last; ++z) farthest[tile] = std::max(farthest[tile], *z);
      }
    }
  });
}

void TsdfIntegrator::AllocateBand(const PreparedDepth& depth, const RigidTransform& T_map_depth,
                                  ThreadPool& pool, TsdfVolume& volume) {
  const CameraF camera(depth.camera);
  const VoxelGrid& grid = volume.grid();
  BandRowArgs args{};
  args.width = camera.width;
  args.fx = camera.fx;
  args.cx = camera.cx;
  const Eigen::Matrix<float, 3, 3, Eigen::RowMajor> R =
      (T_map_depth.linear() / grid.block_size_m()).cast<float>();
  const Eigen::Vector3f t =
      ((T_map_depth.translation() - grid.min_m) / grid.block_size_m() + Eigen::Vector3d::Ones())
          .cast<float>();
  std::copy_n(R.data(), 9, args.R);
  std::copy_n(t.data(), 3, args.t);
  args.truncation_m = static_cast<float>(volume.truncation_distance_m());
  // Samples along the ray at most half a block apart, both ends of the band included.
  args.half_steps = std::max(
      1, static_cast<int>(std::ceil(2.0 * volume.truncation_distance_m() / grid.block_size_m())));
  args.table = volume.table().data();
  args.stride_y = volume.table_stride_y();
  args.stride_z = volume.table_stride_z();
  std::copy_n(grid.blocks.data(), 3, args.blocks);

  const int strips = (camera.height + kTile - 1) / kTile;
  missing_by_strip_.resize(static_cast<std::size_t>(strips));
  pool.ParallelFor(strips, [&](int strip) {
    std::vector<std::int32_t>& missing = missing_by_strip_[strip];
    std::size_t count = 0;
    const int end = std::min(camera.height, (strip + 1) * kTile);
    for (int y = strip * kTile; y < end; y += kAllocationStride) {
      BandRowArgs row = args;
      row.depth_m = depth.depth_m.Row(y).data();
      row.ray_y = (static_cast<float>(y) - camera.cy) / camera.fy;
      missing.resize(count + static_cast<std::size_t>(BandRowCapacity(row)));
      count += static_cast<std::size_t>(FindMissingBlocks(row, missing.data() + count));
    }
    missing.resize(count);
  });
  // Allocated in order and by one thread: numbers of blocks must not depend on the number of
  // threads.
  for (const std::vector<std::int32_t>& missing : missing_by_strip_) {
    for (const std::int32_t entry : missing) volume.FindOrAllocateEntry(entry);
  }
}

void TsdfIntegrator::SelectBlocks(const CameraModel& camera, const RigidTransform& T_map_depth,
                                  const TsdfVolume& volume) {
  const VoxelGrid& grid = volume.grid();
  const float reach_m =
      BlockRadius(grid) + 2.0F * static_cast<float>(volume.truncation_distance_m());
  const BlockTiles tiles(grid, camera, T_map_depth,
                         {kTile, farthest_m_.width(), farthest_m_.height()});
  // Blocks that are entirely behind all that is measured where they project are skipped.
  const auto may_be_seen = [&](int x, int y, float depth_m) {
    const float farthest_m = farthest_m_.At(x, y);
    return farthest_m > 0.0F && depth_m - reach_m <= farthest_m;
  };
  updated_blocks_.clear();
  for (const std::int32_t block : visible_.Find(volume, camera, T_map_depth)) {
    if (tiles.AnyOf(volume.block_coordinates(block), may_be_seen)) updated_blocks_.push_back(block);
  }
}

void TsdfIntegrator::Integrate(const PreparedDepth& depth, const RigidTransform& T_map_depth,
                               ThreadPool& pool, TsdfVolume& volume) {
  MakeSamples(depth, pool);
  AllocateBand(depth, T_map_depth, pool, volume);
  SelectBlocks(depth.camera, T_map_depth, volume);

  const RigidTransform T_depth_map = T_map_depth.inverse();
  const CameraF camera(depth.camera);
  const VoxelGrid& grid = volume.grid();
  IntegrationKernelArgs args{};
  args.samples = samples_.data();
  args.width = camera.width;
  args.height = camera.height;
  args.fx = camera.fx;
  args.fy = camera.fy;
  args.cx = camera.cx;
  args.cy = camera.cy;
  const Eigen::Matrix<float, 3, 3, Eigen::RowMajor> axes =
      (T_depth_map.linear() * grid.voxel_size_m).cast<float>();
  std::copy_n(axes.data(), 9, args.axes);
  args.truncation_m = static_cast<float>(volume.truncation_distance_m());
  args.max_weight = static_cast<float>(options_.expert().max_weight());
  args.noise_at_1m = depth.noise_at_1m;
  // A frame updates hundreds to thousands of blocks: enough tasks for all threads, few enough to
  // hand out. Not tuned.
  constexpr int kBlocksPerTask = 32;
  const int count = static_cast<int>(updated_blocks_.size());
  pool.ParallelFor((count + kBlocksPerTask - 1) / kBlocksPerTask, [&](int task) {
    const int end = std::min(count, (task + 1) * kBlocksPerTask);
    for (int i = task * kBlocksPerTask; i < end; ++i) {
      const std::int32_t block = updated_blocks_[i];
      const Eigen::Vector3f first =
          (T_depth_map * grid.VoxelCentre(volume.block_coordinates(block) * kBlockSide))
              .cast<float>();
      // Rays skip blocks without voxels behind the surface, which are most of them.
      volume.set_may_end_rays(
          block, IntegrateBlock(args, first.data(), &volume.voxels(block).front().bits));
    }
  });
}

bool IntegrationGate::Accepts(const std::optional<RigidTransform>& previous,
                              const RigidTransform& T_map_depth) {
  const auto exceeds = [](double value, double bound) { return bound > 0.0 && value > bound; };
  const bool young = bootstrapping();
  bool accept = true;
  if (previous && !young) {
    accept =
        !exceeds(TranslationDistance(*previous, T_map_depth), options_.expert().max_step_m()) &&
        !exceeds(RotationAngle(*previous, T_map_depth),
                 options_.expert().max_step_deg() * kRadPerDeg);
  } else if (!previous && last_integrated_) {
    accept = false;  // The motion since the frame before is not known.
  }
  if (accept && last_integrated_ && !young) {
    accept =
        TranslationDistance(*last_integrated_, T_map_depth) >= options_.expert().min_step_m() ||
        RotationAngle(*last_integrated_, T_map_depth) >=
            options_.expert().min_step_deg() * kRadPerDeg;
  }
  if (accept) {
    last_integrated_ = T_map_depth;
    ++accepted_;
  }
  return accept;
}

}  // namespace isotherm
