#include "ground/thermal/thermal_fuser.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <numbers>

#include "ground/thermal/upsample_kernel.h"

namespace isotherm {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr int kRowsPerTask = 8;

/// Side of the tiles whose depths are kept to choose blocks; a row of tiles is one task.
constexpr int kTile = kRowsPerTask;

constexpr double kRadPerDeg = std::numbers::pi / 180.0;

float CosineOfDegrees(double degrees) { return static_cast<float>(std::cos(degrees * kRadPerDeg)); }

template <typename Row>
void ForRows(int height, ThreadPool& pool, const Row& row) {
  pool.ParallelFor((height + kRowsPerTask - 1) / kRowsPerTask, [&](int task) {
    const int end = std::min(height, (task + 1) * kRowsPerTask);
    for (int y = task * kRowsPerTask; y < end; ++y) row(y);
  });
}

/// Every second pixel each way, and one beyond the last.
CameraModel EverySecondPixel(CameraModel camera) {
  camera.width = camera.width / 2 + 1;
  camera.height = camera.height / 2 + 1;
  for (double* parameter : {&camera.fx, &camera.fy, &camera.cx, &camera.cy}) *parameter *= 0.5;
  return camera;
}

/// Smaller is better: good before acceptable before unchecked.
int Rank(ConditionClass c) { return static_cast<int>(c); }

}  // namespace

Status Validate(const ThermalOptions& o) {
  if (!(o.distance_min_m() >= 0.0 && o.distance_min_m() < o.distance_good_m() &&
        o.distance_good_m() <= o.distance_max_m())) {
    return InvalidArgument(
        fmt::format("thermal: need 0 <= distance_min_m < distance_good_m <= distance_max_m, got {} "
                    "m, {} m, {} m",
                    o.distance_min_m(), o.distance_good_m(), o.distance_max_m()));
  }
  if (!(o.angle_min_deg() >= 0.0 && o.angle_min_deg() < o.angle_good_deg() &&
        o.angle_good_deg() <= o.angle_max_deg() && o.angle_max_deg() <= 90.0)) {
    return InvalidArgument(
        fmt::format("thermal: need 0 <= angle_min_deg < angle_good_deg <= angle_max_deg <= 90, got "
                    "{}, {}, {} degrees",
                    o.angle_min_deg(), o.angle_good_deg(), o.angle_max_deg()));
  }
  if (!(o.parallax_tolerance_m() > 0.0 && o.vertex_distance_vox() > 0.0 && o.max_wait_s() >= 0.0 &&
        o.max_wait_s() <= 10.0)) {
    return InvalidArgument(
        "thermal: parallax_tolerance_m and vertex_distance_vox must be positive, max_wait_s 0..10 "
        "s");
  }
  if (o.edge_margin_px() < 0 || o.edge_margin_px() > 16) {
    return InvalidArgument(
        fmt::format("thermal.edge_margin_px must be 0..16 pixels, got {}", o.edge_margin_px()));
  }
  if (!(o.max_registration_px() > 0.0)) {
    return InvalidArgument(fmt::format("thermal.max_registration_px must be positive, got {} px",
                                       o.max_registration_px()));
  }
  if (o.visibility_halvings() != 0 && o.visibility_halvings() != 1) {
    return InvalidArgument(
        fmt::format("thermal.visibility_halvings must be 0 or 1, got {}", o.visibility_halvings()));
  }
  return OkStatus();
}

ConditionLimits::ConditionLimits(const ThermalOptions& o)
    : distance_min_m(static_cast<float>(o.distance_min_m())),
      distance_good_m(static_cast<float>(o.distance_good_m())),
      distance_max_m(static_cast<float>(o.distance_max_m())),
      cosine_min_angle(CosineOfDegrees(o.angle_min_deg())),
      cosine_good_angle(CosineOfDegrees(o.angle_good_deg())),
      cosine_max_angle(CosineOfDegrees(o.angle_max_deg())) {}

ConditionClass ConditionLimits::ClassifyDistance(float d) const {
  if (!(d >= distance_min_m && d <= distance_max_m)) return ConditionClass::kBad;
  return d <= distance_good_m ? ConditionClass::kGood : ConditionClass::kAcceptable;
}

ConditionClass ConditionLimits::ClassifyAngle(float cosine) const {
  if (!(cosine <= cosine_min_angle && cosine >= cosine_max_angle)) return ConditionClass::kBad;
  return cosine >= cosine_good_angle ? ConditionClass::kGood : ConditionClass::kAcceptable;
}

bool ReplacesMeasurement(ConditionClass new_distance, ConditionClass new_angle,
                         ConditionClass new_motion, ThermalVoxel old) {
  const auto valid = [](ConditionClass distance, ConditionClass angle) {
    return distance != ConditionClass::kBad && angle != ConditionClass::kBad;
  };
  if (new_motion == ConditionClass::kBad) return false;
  if (!old.measured() || !valid(old.distance_class(), old.angle_class())) return true;
  if (!valid(new_distance, new_angle)) return false;
  if (new_distance != old.distance_class()) return Rank(new_distance) < Rank(old.distance_class());
  if (new_angle != old.angle_class()) return Rank(new_angle) < Rank(old.angle_class());
  return Rank(new_motion) <= Rank(old.motion_class());
}

ThermalRectifier::ThermalRectifier(const CameraModel& camera)
    : ideal_(camera.WithoutDistortion()),
      source_(camera.width, camera.height, -1),
      fraction_x_(camera.width, camera.height),
      fraction_y_(camera.width, camera.height) {
  for (int v = 0; v < camera.height; ++v) {
    for (int u = 0; u < camera.width; ++u) {
      const Eigen::Vector2d pixel = ProjectNormalized(camera, Unproject(ideal_, {u, v}));
      if (!(pixel.x() >= 0.0 && pixel.y() >= 0.0 && pixel.x() <= camera.width - 1 &&
            pixel.y() <= camera.height - 1)) {
        continue;
      }
      const int x = std::min(static_cast<int>(pixel.x()), camera.width - 2);
      const int y = std::min(static_cast<int>(pixel.y()), camera.height - 2);
      source_.At(u, v) = y * camera.width + x;
      fraction_x_.At(u, v) = static_cast<float>(pixel.x() - x);
      fraction_y_.At(u, v) = static_cast<float>(pixel.y() - y);
    }
  }
}

void ThermalRectifier::Rectify(const Image<std::uint16_t>& centikelvin, int apron, ThreadPool& pool,
                               Image<float>& celsius) {
  const int width = ideal_.width;
  const int height = ideal_.height;
  picture_.Resize(width, height);
  if (celsius.width() != width + 2 * apron || celsius.height() != height + 2 * apron)
    celsius = Image<float>(width + 2 * apron, height + 2 * apron, kNan);
  const int tasks = (height + kRowsPerTask - 1) / kRowsPerTask;
  pool.ParallelFor(tasks, [&](int task) {
    const auto begin = static_cast<std::size_t>(task * kRowsPerTask * width);
    const auto end =
        std::min(picture_.size(), begin + static_cast<std::size_t>(kRowsPerTask * width));
    for (std::size_t i = begin; i < end; ++i) {
      const std::uint16_t raw = centikelvin.data()[i];
      picture_.data()[i] = raw == 0 ? kNan : static_cast<float>(raw) * 0.01F - 273.15F;
    }
  });
  ForRows(height, pool, [&](int v) {
    ResampleRow({picture_.data(), width, source_.Row(v).data(), fraction_x_.Row(v).data(),
                 fraction_y_.Row(v).data(), width},
                celsius.Row(v + apron).data() + apron);
  });
}

ThermalFuser::ThermalFuser(const ThermalOptions& options, const CameraModel& thermal_camera,
                           float min_weight)
    : options_(options),
      limits_(options),
      min_weight_(min_weight),
      apron_(std::max(1, options.edge_margin_px())),
      rectifier_(thermal_camera) {
  const int width = thermal_camera.width;
  const int height = thermal_camera.height;
  distances_m_ =
      Image<float>(width + 2 * apron_, height + 2 * apron_, std::numeric_limits<float>::max());
  pixels_.resize(static_cast<std::size_t>(width) * static_cast<std::size_t>(height) + 1);
  const int tiles_x = (width + kTile - 1) / kTile;
  const int tiles_y = (height + kTile - 1) / kTile;
  nearest_m_.Resize(tiles_x, tiles_y);
  farthest_m_.Resize(tiles_x, tiles_y);
}

void ThermalFuser::CastSurface(const RigidTransform& T_world_thermal, const TsdfVolume& tsdf,
                               ThreadPool& pool) {
  const CameraModel& camera = rectifier_.ideal_camera();
  const bool halved = options_.visibility_halvings() == 1;
  if (halved) {
    raycaster_.Cast(tsdf, EverySecondPixel(camera), T_world_thermal, min_weight_, pool, coarse_);
    surface_.Resize(camera.width, camera.height);
  } else {
    raycaster_.Cast(tsdf, camera, T_world_thermal, min_weight_, pool, surface_);
  }
  UpsampleRowArgs args{};
  args.coarse = &coarse_;
  // Half of what counts as an occluder: a corner is bridged, an edge is not.
  args.max_plane_distance_m = static_cast<float>(0.5 * options_.parallax_tolerance_m());
  const Eigen::Vector3f position = T_world_thermal.translation().cast<float>();
  std::copy_n(position.data(), 3, args.position);
  ForRows(camera.height, pool, [&](int y) {
    float* distance_m = distances_m_.Row(y + apron_).data() + apron_;
    if (halved) {
      UpsampleRow(args, y, surface_, distance_m);
    } else {
      DistanceRow(surface_.vx.Row(y).data(), surface_.vy.Row(y).data(), surface_.vz.Row(y).data(),
                  args.position, camera.width, distance_m);
    }
  });
}

std::int64_t ThermalFuser::MakePixels(const RigidTransform& T_world_thermal,
                                      const CameraModel& depth_camera,
                                      const RigidTransform& T_world_depth, ThreadPool& pool) {
  const int width = surface_.width();
  const int height = surface_.height();
  PixelRowArgs args{};
  args.distance_stride = distances_m_.width();
  args.celsius_stride = celsius_.width();
  args.margin = options_.edge_margin_px();
  args.width = width;
  const Eigen::Vector3f position = T_world_thermal.translation().cast<float>();
  std::copy_n(position.data(), 3, args.position);
  const Eigen::Vector4f z_axis = T_world_thermal.inverse().matrix().row(2).cast<float>();
  std::copy_n(z_axis.data(), 4, args.z_axis);
  const RigidTransform T_depth_world = T_world_depth.inverse();
  const Eigen::Matrix<float, 3, 3, Eigen::RowMajor> R = T_depth_world.linear().cast<float>();
  const Eigen::Vector3f t = T_depth_world.translation().cast<float>();
  std::copy_n(R.data(), 9, args.R_depth);
  std::copy_n(t.data(), 3, args.t_depth);
  args.depth_fx = static_cast<float>(depth_camera.fx);
  args.depth_fy = static_cast<float>(depth_camera.fy);
  args.depth_cx = static_cast<float>(depth_camera.cx);
  args.depth_cy = static_cast<float>(depth_camera.cy);
  args.depth_width = static_cast<float>(depth_camera.width);
  args.depth_height = static_cast<float>(depth_camera.height);
  args.occlusion_tolerance_m = static_cast<float>(options_.parallax_tolerance_m());
  args.distance_min_m = limits_.distance_min_m;
  args.distance_good_m = limits_.distance_good_m;
  args.distance_max_m = limits_.distance_max_m;
  args.cosine_min_angle = limits_.cosine_min_angle;
  args.cosine_good_angle = limits_.cosine_good_angle;
  args.cosine_max_angle = limits_.cosine_max_angle;

  const int tasks = (height + kRowsPerTask - 1) / kRowsPerTask;
  std::atomic<std::int64_t> occluded{0};
  pool.ParallelFor(tasks, [&](int task) {
    const std::span<float> nearest = nearest_m_.Row(task);
    const std::span<float> farthest = farthest_m_.Row(task);
    std::fill(nearest.begin(), nearest.end(), std::numeric_limits<float>::max());
    std::fill(farthest.begin(), farthest.end(), 0.0F);
    const int end = std::min(height, (task + 1) * kRowsPerTask);
    std::int64_t hidden = 0;
    for (int y = task * kRowsPerTask; y < end; ++y) {
      PixelRowArgs row = args;
      row.vx = surface_.vx.Row(y).data();
      row.vy = surface_.vy.Row(y).data();
      row.vz = surface_.vz.Row(y).data();
      row.nx = surface_.nx.Row(y).data();
      row.ny = surface_.ny.Row(y).data();
      row.nz = surface_.nz.Row(y).data();
      row.distance_m = distances_m_.Row(y + apron_).data() + apron_;
      row.celsius = celsius_.Row(y + apron_).data() + apron_;
      ThermalPixel* pixels =
          pixels_.data() + static_cast<std::size_t>(y) * static_cast<std::size_t>(width);
      hidden += MakePixelRow(row, pixels);
      for (int x = 0; x < width; ++x) {
        const float depth = pixels[x].depth_m;
        const auto tile = static_cast<std::size_t>(x / kTile);
        farthest[tile] = std::max(farthest[tile], depth);
        if (depth > 0.0F) nearest[tile] = std::min(nearest[tile], depth);
      }
    }
    occluded += hidden;
  });
  return occluded;
}

void ThermalFuser::SelectBlocks(const RigidTransform& T_world_thermal, const TsdfVolume& tsdf) {
  const CameraModel& camera = rectifier_.ideal_camera();
  const BlockToCamera to_camera(tsdf.grid(), T_world_thermal.inverse());
  const float radius = BlockRadius(tsdf.grid());
  const float reach =
      radius + static_cast<float>(options_.vertex_distance_vox() * tsdf.grid().voxel_size_m);
  const auto fx = static_cast<float>(camera.fx);
  const auto fy = static_cast<float>(camera.fy);
  const auto cx = static_cast<float>(camera.cx);
  const auto cy = static_cast<float>(camera.cy);
  const auto tile_of = [](float pixel, int tiles) {
    return std::clamp(static_cast<int>(pixel) / kTile, 0, tiles - 1);
  };
  blocks_.clear();
  for (const std::int32_t block : visible_.Find(tsdf, camera, T_world_thermal)) {
    const Eigen::Vector3f p = to_camera.Centre(tsdf.block_coordinates(block));
    if (p.z() < 2.0F * radius) continue;
    // Keep blocks through which the visible surface passes.
    const float extent = radius * 1.5F / (p.z() - radius);
    const float u = fx * p.x() / p.z() + cx;
    const float v = fy * p.y() / p.z() + cy;
    const int x1 = tile_of(u + fx * extent, nearest_m_.width());
    const int y1 = tile_of(v + fy * extent, nearest_m_.height());
    bool on_surface = false;
    for (int y = tile_of(v - fy * extent, nearest_m_.height()); y <= y1 && !on_surface; ++y) {
      for (int x = tile_of(u - fx * extent, nearest_m_.width()); x <= x1 && !on_surface; ++x) {
        on_surface = p.z() - reach <= farthest_m_.At(x, y) && p.z() + reach >= nearest_m_.At(x, y);
      }
    }
    if (on_surface) blocks_.push_back(block);
  }
}

FusionReport ThermalFuser::Fuse(const ThermalFrame& frame, const RigidTransform& T_world_thermal,
                                const CameraModel& depth_camera,
                                const RigidTransform& T_world_depth, const TsdfVolume& tsdf,
                                ThreadPool& pool, ThermalVolume& thermal) {
  const CameraModel& camera = rectifier_.ideal_camera();
  CHECK(frame.valid);
  CHECK(IsRigid(T_world_thermal) && IsRigid(T_world_depth));
  CHECK(frame.centikelvin.width() == camera.width && frame.centikelvin.height() == camera.height);
  rectifier_.Rectify(frame.centikelvin, apron_, pool, celsius_);
  CastSurface(T_world_thermal, tsdf, pool);
  FusionReport report;
  report.occluded = MakePixels(T_world_thermal, depth_camera, T_world_depth, pool);
  SelectBlocks(T_world_thermal, tsdf);

  const VoxelGrid& grid = tsdf.grid();
  const RigidTransform T_thermal_world = T_world_thermal.inverse();
  FusionKernelArgs args{};
  args.pixels = pixels_.data();
  args.width = camera.width;
  args.height = camera.height;
  args.fx = static_cast<float>(camera.fx);
  args.fy = static_cast<float>(camera.fy);
  args.cx = static_cast<float>(camera.cx);
  args.cy = static_cast<float>(camera.cy);
  const Eigen::Matrix<float, 3, 3, Eigen::RowMajor> axes =
      (T_thermal_world.linear() * grid.voxel_size_m).cast<float>();
  std::copy_n(axes.data(), 9, args.axes);
  const double max_distance_m = options_.vertex_distance_vox() * grid.voxel_size_m;
  args.max_distance_m = static_cast<float>(max_distance_m);
  // A distance measured along a normal is at most that to the vertex, but for noise.
  constexpr double kNoiseMargin = 1.25;
  args.max_tsdf_code = static_cast<std::int32_t>(
      TsdfVoxel::kTsdfScale *
      std::min(1.0, kNoiseMargin * max_distance_m / tsdf.truncation_distance_m()));
  args.validate = options_.validation();
  std::atomic<std::int64_t> considered{0};
  std::atomic<std::int64_t> assigned{0};
  constexpr int kBlocksPerTask = 32;
  const int count = static_cast<int>(blocks_.size());
  pool.ParallelFor((count + kBlocksPerTask - 1) / kBlocksPerTask, [&](int task) {
    FusionKernelCounts counts;
    const int end = std::min(count, (task + 1) * kBlocksPerTask);
    for (int i = task * kBlocksPerTask; i < end; ++i) {
      const std::int32_t block = blocks_[i];
      const Eigen::Vector3f first =
          (T_thermal_world * grid.VoxelCentre(tsdf.block_coordinates(block) * kBlockSide))
              .cast<float>();
      FuseBlock(args, first.data(), &tsdf.voxels(block).front().bits,
                &thermal.voxels(block).front().bits, counts);
    }
    considered += counts.considered;
    assigned += counts.assigned;
  });
  report.considered = considered;
  report.assigned = assigned;
  return report;
}

}  // namespace isotherm
