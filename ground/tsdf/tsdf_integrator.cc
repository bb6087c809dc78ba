#include "ground/tsdf/tsdf_integrator.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "ground/tracker/depth_preprocessor.h"

namespace isotherm {
namespace {

constexpr double kRadPerDeg = std::numbers::pi / 180.0;
constexpr int kRowsPerTask = 16;

/// Every n-th pixel allocates blocks: at 1 m and 570 px focal length two pixels are 3.5 mm apart.
constexpr int kAllocationStride = 2;

/// Weight of an observation: the variance of triangulated depth grows with the fourth power of
/// depth, but far surfaces must still be learnt in a few frames.
constexpr float kReferenceDepth = 0.5F;
constexpr float kMinWeight = 0.25F;
/// Without a normal the point lies on an edge, where depth is least certain.
constexpr float kEdgeWeight = 0.125F;

float DepthWeight(float depth) {
  const float ratio = kReferenceDepth / depth;
  return std::clamp(ratio * ratio, kMinWeight, 1.0F);
}

struct CameraF {
  float fx, fy, cx, cy;
  int width, height;
  explicit CameraF(const CameraModel& c)
      : fx(static_cast<float>(c.fx)),
        fy(static_cast<float>(c.fy)),
        cx(static_cast<float>(c.cx)),
        cy(static_cast<float>(c.cy)),
        width(c.width),
        height(c.height) {}
};

}  // namespace

Status Validate(const TsdfOptions& o, const VolumeOptions& volume) {
  if (!(o.truncation_distance_m() >= 2.0 * volume.voxel_size_m() &&
        o.truncation_distance_m() <= 1.0)) {
    return InvalidArgument(fmt::format(
        "tsdf.truncation_distance_m must be at least two voxels ({} m) and at most 1 m, got {} m",
        2.0 * volume.voxel_size_m(), o.truncation_distance_m()));
  }
  if (!(o.max_weight() >= 1.0 && o.max_weight() <= 1000.0)) {
    return InvalidArgument(
        fmt::format("tsdf.max_weight must be 1..1000 observations, got {}", o.max_weight()));
  }
  for (const double bound : {o.min_step_m(), o.max_step_m(), o.min_step_deg(), o.max_step_deg()}) {
    if (!(bound >= 0.0))
      return InvalidArgument("tsdf: step bounds must not be negative (0 turns one off)");
  }
  if ((o.max_step_m() > 0.0 && o.min_step_m() > o.max_step_m()) ||
      (o.max_step_deg() > 0.0 && o.min_step_deg() > o.max_step_deg())) {
    return InvalidArgument("tsdf: min_step must not exceed max_step");
  }
  return OkStatus();
}

void TsdfIntegrator::MakeSamples(const PreparedDepth& depth, ThreadPool& pool) {
  const CameraF camera(depth.camera);
  samples_.Resize(camera.width, camera.height);
  const SurfaceMaps& maps = depth.maps[0];
  pool.ParallelFor((camera.height + kRowsPerTask - 1) / kRowsPerTask, [&](int task) {
    const int end = std::min(camera.height, (task + 1) * kRowsPerTask);
    for (int y = task * kRowsPerTask; y < end; ++y) {
      for (int x = 0; x < camera.width; ++x) {
        DepthSample& s = samples_.At(x, y);
        const float z = depth.depth_m.At(x, y);
        s.depth_m = z;
        s.weight = 0.0F;
        if (!(z > 0.0F)) continue;
        const Eigen::Vector3f p((static_cast<float>(x) - camera.cx) / camera.fx * z,
                                (static_cast<float>(y) - camera.cy) / camera.fy * z, z);
        const Eigen::Vector3f to_camera = -p.normalized();
        Eigen::Vector3f n(maps.nx.At(x, y), maps.ny.At(x, y), maps.nz.At(x, y));
        const float cosine = n.dot(to_camera);
        if (cosine > 0.0F) {
          s.weight = DepthWeight(z) * cosine;
        } else {
          n = to_camera;
          s.weight = DepthWeight(z) * kEdgeWeight;
        }
        s.nx = n.x();
        s.ny = n.y();
        s.nz = n.z();
        s.offset = n.dot(p);
      }
    }
  });
}

void TsdfIntegrator::AllocateBand(const PreparedDepth& depth, const RigidTransform& T_world_depth,
                                  ThreadPool& pool, TsdfVolume& volume) {
  const CameraF camera(depth.camera);
  const VoxelGrid& grid = volume.grid();
  const auto truncation = static_cast<float>(volume.truncation_distance_m());
  const auto inverse_block = static_cast<float>(1.0 / grid.block_size_m());
  // Block coordinates of a camera point: B = (R p + t - min) / block.
  const Eigen::Matrix3f R = (T_world_depth.linear() / grid.block_size_m()).cast<float>();
  const Eigen::Vector3f t =
      ((T_world_depth.translation() - grid.min_m) / grid.block_size_m()).cast<float>();
  // Samples along the ray at most half a block apart, both ends of the band included.
  const int half_steps =
      std::max(1, static_cast<int>(std::ceil(2.0F * truncation * inverse_block)));
  const float step = truncation / static_cast<float>(half_steps);

  const int strips = (camera.height + kRowsPerTask - 1) / kRowsPerTask;
  touched_by_strip_.resize(static_cast<std::size_t>(strips));
  pool.ParallelFor(strips, [&](int strip) {
    std::vector<GridIndex>& touched = touched_by_strip_[strip];
    touched.clear();
    const std::size_t steps = static_cast<std::size_t>(2 * half_steps + 1);
    std::vector<GridIndex> last(steps, GridIndex::Constant(-1));
    const int end = std::min(camera.height, (strip + 1) * kRowsPerTask);
    for (int y = strip * kRowsPerTask; y < end; y += kAllocationStride) {
      for (int x = 0; x < camera.width; x += kAllocationStride) {
        const float z = depth.depth_m.At(x, y);
        if (!(z > 0.0F)) continue;
        const Eigen::Vector3f p((static_cast<float>(x) - camera.cx) / camera.fx * z,
                                (static_cast<float>(y) - camera.cy) / camera.fy * z, z);
        const Eigen::Vector3f b = R * p + t;
        const Eigen::Vector3f direction = R * p.normalized();
        for (std::size_t i = 0; i < steps; ++i) {
          const float along = (static_cast<float>(i) - static_cast<float>(half_steps)) * step;
          const GridIndex block = (b + along * direction).array().floor().cast<int>();
          if (block == last[i]) continue;
          last[i] = block;
          if (volume.InGrid(block) && volume.Find(block) == TsdfVolume::kNoBlock)
            touched.push_back(block);
        }
      }
    }
  });
  for (const std::vector<GridIndex>& touched : touched_by_strip_) {
    for (const GridIndex& block : touched) volume.FindOrAllocate(block);
  }
}

void TsdfIntegrator::SelectBlocks(const PreparedDepth& depth, const RigidTransform& T_depth_world,
                                  const TsdfVolume& volume) {
  const CameraF camera(depth.camera);
  const VoxelGrid& grid = volume.grid();
  const auto block_m = static_cast<float>(grid.block_size_m());
  const float radius = 0.5F * std::sqrt(3.0F) * block_m;
  const float reach = radius + 2.0F * static_cast<float>(volume.truncation_distance_m());
  const Eigen::Matrix3f R = T_depth_world.linear().cast<float>();
  const Eigen::Vector3f t = T_depth_world.translation().cast<float>();
  const Eigen::Vector3f min = grid.min_m.cast<float>();
  updated_blocks_.clear();
  for (std::int32_t block = 0; block < volume.block_count(); ++block) {
    const Eigen::Vector3f centre =
        min +
        (volume.block_coordinates(block).cast<float>() + Eigen::Vector3f::Constant(0.5F)) * block_m;
    const Eigen::Vector3f p = R * centre + t;
    if (p.z() < radius) continue;
    const float u = camera.fx * p.x() / p.z() + camera.cx;
    const float v = camera.fy * p.y() / p.z() + camera.cy;
    const float margin = radius * camera.fx / (p.z() - 0.5F * radius);
    if (u < -margin || v < -margin || u > static_cast<float>(camera.width) + margin ||
        v > static_cast<float>(camera.height) + margin) {
      continue;
    }
    // Skip blocks that are entirely behind what is measured around their centre and corners.
    bool maybe_seen = false;
    for (int dy = -1; dy <= 1 && !maybe_seen; ++dy) {
      for (int dx = -1; dx <= 1 && !maybe_seen; ++dx) {
        const int x =
            std::clamp(static_cast<int>(u + static_cast<float>(dx) * margin), 0, camera.width - 1);
        const int y =
            std::clamp(static_cast<int>(v + static_cast<float>(dy) * margin), 0, camera.height - 1);
        const float z = depth.depth_m.At(x, y);
        maybe_seen = z > 0.0F && p.z() - reach <= z;
      }
    }
    if (maybe_seen) updated_blocks_.push_back(block);
  }
}

void TsdfIntegrator::Integrate(const PreparedDepth& depth, const RigidTransform& T_world_depth,
                               ThreadPool& pool, TsdfVolume& volume) {
  MakeSamples(depth, pool);
  AllocateBand(depth, T_world_depth, pool, volume);
  const RigidTransform T_depth_world = T_world_depth.inverse();
  SelectBlocks(depth, T_depth_world, volume);

  const CameraF camera(depth.camera);
  const VoxelGrid& grid = volume.grid();
  IntegrationKernelArgs args{};
  args.samples = &samples_.data()->nx;
  args.width = camera.width;
  args.height = camera.height;
  args.fx = camera.fx;
  args.fy = camera.fy;
  args.cx = camera.cx;
  args.cy = camera.cy;
  const Eigen::Matrix<float, 3, 3, Eigen::RowMajor> axes =
      (T_depth_world.linear() * grid.voxel_size_m).cast<float>();
  std::copy_n(axes.data(), 9, args.axes);
  args.truncation_m = static_cast<float>(volume.truncation_distance_m());
  args.max_weight = static_cast<float>(options_.max_weight());
  constexpr int kBlocksPerTask = 32;
  const int count = static_cast<int>(updated_blocks_.size());
  pool.ParallelFor((count + kBlocksPerTask - 1) / kBlocksPerTask, [&](int task) {
    const int end = std::min(count, (task + 1) * kBlocksPerTask);
    for (int i = task * kBlocksPerTask; i < end; ++i) {
      const std::int32_t block = updated_blocks_[i];
      const Eigen::Vector3f first =
          (T_depth_world * grid.VoxelCentre(volume.block_coordinates(block) * kBlockSide))
              .cast<float>();
      IntegrateBlock(args, first.data(), &volume.voxels(block).front().bits);
    }
  });
}

bool IntegrationGate::Accepts(const std::optional<RigidTransform>& previous,
                              const RigidTransform& T_world_depth) {
  const auto exceeds = [](double value, double bound) { return bound > 0.0 && value > bound; };
  const bool bootstrapping =
      accepted_ < static_cast<std::uint64_t>(std::max(0, options_.bootstrap_frames()));
  bool accept = true;
  if (previous && !bootstrapping) {
    accept =
        !exceeds(TranslationDistance(*previous, T_world_depth), options_.max_step_m()) &&
        !exceeds(RotationAngle(*previous, T_world_depth), options_.max_step_deg() * kRadPerDeg);
  } else if (!previous && last_integrated_) {
    accept = false;  // The motion since the frame before is not known.
  }
  if (accept && last_integrated_ && !bootstrapping) {
    accept =
        TranslationDistance(*last_integrated_, T_world_depth) >= options_.min_step_m() ||
        RotationAngle(*last_integrated_, T_world_depth) >= options_.min_step_deg() * kRadPerDeg;
  }
  if (accept) {
    last_integrated_ = T_world_depth;
    ++accepted_;
  }
  return accept;
}

}  // namespace isotherm
