#include "ground/thermal/thermal_fuser.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <limits>

#include "ground/surface/upsample_kernel.h"
#include "ground/thermal/thermal_options.h"

namespace isotherm {
namespace {

// Rows of the thermal image: 36 tasks for the 288 rows of a PI 450. Not tuned.
constexpr int kRowsPerTask = 8;

/// Side of the tiles whose depths are kept to choose blocks; a row of tiles is one task.
constexpr int kTile = kRowsPerTask;

/// A temperature is known where its pixel is to about half a pixel: interpolation between pixels
/// and what a lens spreads. Smaller: steep pixels beside edges get through; larger: more of the
/// surface has no temperature. Not tuned.
constexpr double kPixelUncertainty_px = 0.5;
/// A block in view is reviewed once in this many frames, at 40 Hz more than twice a second. More
/// often: time for surface that has hardly changed; less often: what a better surface proves wrong
/// stays longer, and the final review finds it (docs/performance.md: without that one 0.51 instead
/// of 0.31 % of the temperatures are beyond 5 K).
constexpr std::uint32_t kFramesBetweenReviews = 16;
/// Stands for no limit; its square is finite.
constexpr float kNoLimit = 1e18F;

/// For the row of `camera`'s image that sees normalised row `y` of the ideal camera, above or below
/// its principal point: how many rows it is from the middle one.
double RowsFromMiddle(const CameraModel& camera, double y) {
  const double middle = 0.5 * (camera.height - 1);
  return std::min(std::abs(ProjectNormalized(camera, {0.0, y}).y() - middle), middle);
}

BlockSigmas SigmasOf(const ThermalVolume& thermal, std::int32_t block) {
  static_assert(BlockSigmas::kRowVoxels == RecordRow::kVoxels);
  BlockSigmas sigmas;
  if (thermal.records() == nullptr) return sigmas;
  for (int row = 0; row < BlockSigmas::kRows; ++row)
    sigmas.rows[static_cast<std::size_t>(row)] = thermal.records()->FindSigmas(block, row);
  return sigmas;
}

/// Mean of what has a value, °C; 0 if nothing has.
double MeanCelsius(const Image<float>& celsius) {
  double sum = 0.0;
  std::size_t count = 0;
  for (const float value : celsius.pixels()) {
    if (std::isnan(value)) continue;
    sum += static_cast<double>(value);
    ++count;
  }
  return count == 0 ? 0.0 : sum / static_cast<double>(count);
}

template <typename Vector>
void CopyVector(const Vector& from, float* to) {
  const Eigen::Vector3f single = from.template cast<float>();
  std::copy_n(single.data(), 3, to);
}

void SeeWhatDepthCameraSees(const PosedThermalFrame& posed, PixelRowArgs& args) {
  const RigidTransform T_depth_map = posed.T_map_depth.inverse();
  const Eigen::Matrix<float, 3, 3, Eigen::RowMajor> R = T_depth_map.linear().cast<float>();
  std::copy_n(R.data(), 9, args.R_depth);
  CopyVector(T_depth_map.translation(), args.t_depth);
  const CameraModel& camera = posed.depth_camera;
  args.depth_fx = static_cast<float>(camera.fx);
  args.depth_fy = static_cast<float>(camera.fy);
  args.depth_cx = static_cast<float>(camera.cx);
  args.depth_cy = static_cast<float>(camera.cy);
  args.depth_width = static_cast<float>(camera.width);
  args.depth_height = static_cast<float>(camera.height);
}

/// A depth camera of one pixel in which every point lies.
void SeeAll(PixelRowArgs& args) {
  std::fill_n(args.R_depth, 9, 0.0F);
  std::copy_n(std::array{0.0F, 0.0F, 1.0F}.data(), 3, args.t_depth);
  args.depth_fx = args.depth_fy = 1.0F;
  args.depth_cx = args.depth_cy = 0.0F;
  args.depth_width = args.depth_height = 1.0F;
}

}  // namespace

FusionReport& FusionReport::operator+=(const FusionReport& other) {
  considered += other.considered;
  occluded += other.occluded;
  smeared += other.smeared;
  steep += other.steep;
  maybe_hidden += other.maybe_hidden;
  assigned += other.assigned;
  dropped += other.dropped;
  return *this;
}

ThermalFuser::ThermalFuser(const ThermalOptions& options, const CameraModel& thermal_camera,
                           const ThermalSensorModel& sensor, float min_weight)
    : options_(options),
      sensor_(sensor),
      limits_(options, sensor),
      review_(options, sensor),
      min_weight_(min_weight),
      apron_(std::max(1, options.expert().occlusion().edge_margin_px())),
      corrections_(CorrectionsOf(options, sensor)),
      rectifier_(thermal_camera, corrections_) {
  const int width = rectifier_.ideal_camera().width;
  const int height = rectifier_.ideal_camera().height;
  // An apron of the largest distance around the image: pixels at its border have neighbours, and no
  // edges there.
  distances_m_ =
      Image<float>(width + 2 * apron_, height + 2 * apron_, std::numeric_limits<float>::max());
  pixels_.resize(static_cast<std::size_t>(width) * static_cast<std::size_t>(height) + 1);
  planes_.resize(pixels_.size());
  const int tiles_x = (width + kTile - 1) / kTile;
  const int tiles_y = (height + kTile - 1) / kTile;
  nearest_m_.Resize(tiles_x, tiles_y);
  farthest_m_.Resize(tiles_x, tiles_y);
}

void ThermalFuser::CastSurface(const RigidTransform& T_map_thermal, const TsdfVolume& tsdf,
                               ThreadPool& pool) {
  const CameraModel& camera = rectifier_.ideal_camera();
  const bool halved = options_.expert().occlusion().visibility_halvings() == 1;
  if (halved) {
    raycaster_.Cast(tsdf, EverySecondPixel(camera), T_map_thermal, min_weight_, pool, coarse_);
    surface_.Resize(camera.width, camera.height);
  } else {
    raycaster_.Cast(tsdf, camera, T_map_thermal, min_weight_, pool, surface_);
  }
  UpsampleRowArgs args{};
  args.coarse = &coarse_;
  // Half of what counts as an occluder: a corner is bridged, an edge is not. Not tuned.
  args.max_plane_distance_m =
      static_cast<float>(0.5 * options_.expert().occlusion().parallax_tolerance_m());
  const Eigen::Vector3f position = T_map_thermal.translation().cast<float>();
  std::copy_n(position.data(), 3, args.position);
  pool.ParallelForRows(camera.height, kRowsPerTask, [&](int y) {
    float* distance_m = distances_m_.Row(y + apron_).data() + apron_;
    if (halved) {
      UpsampleRow(args, y, surface_, distance_m);
    } else {
      DistanceRow(surface_.vx.Row(y).data(), surface_.vy.Row(y).data(), surface_.vz.Row(y).data(),
                  args.position, camera.width, distance_m);
    }
  });
}

PixelRowArgs ThermalFuser::RowArgs(const PosedThermalFrame& posed,
                                   const CaptureConditions& capture) const {
  const CameraModel& camera = rectifier_.ideal_camera();
  const RigidTransform& T_map_thermal = posed.T_map_thermal;
  PixelRowArgs args{};
  args.distance_stride = distances_m_.width();
  args.celsius_stride = celsius_.width();
  args.margin = options_.expert().occlusion().edge_margin_px();
  args.width = camera.width;
  CopyVector(T_map_thermal.translation(), args.position);
  const Eigen::Vector4f z_axis = T_map_thermal.inverse().matrix().row(2).cast<float>();
  std::copy_n(z_axis.data(), 4, args.z_axis);
  CopyVector(T_map_thermal.linear().col(0), args.x_axis);
  CopyVector(T_map_thermal.linear().col(1), args.y_axis);
  if (capture.surface_is_finished) {
    SeeAll(args);
  } else {
    SeeWhatDepthCameraSees(posed, args);
  }
  args.occlusion_tolerance_m =
      static_cast<float>(options_.expert().occlusion().parallax_tolerance_m());
  args.distance_min_m = limits_.distance_min_m;
  args.distance_good_m = limits_.distance_good_m;
  args.distance_max_m = limits_.distance_max_m;
  args.cosine_min_angle = limits_.cosine_min_angle;
  args.cosine_good_angle = limits_.cosine_good_angle;
  args.cosine_max_angle = limits_.cosine_max_angle;
  const auto or_none = [](double limit) {
    return limit > 0.0 ? static_cast<float>(limit) : kNoLimit;
  };
  args.max_footprint_m = or_none(options_.expert().max_footprint_m());
  args.max_error_k = or_none(options_.expert().max_gradient_error_k());
  args.uncertainty_px = static_cast<float>(std::max(kPixelUncertainty_px, capture.registration_px));
  args.fx = static_cast<float>(camera.fx);
  args.fy = static_cast<float>(camera.fy);
  args.cx = static_cast<float>(camera.cx);
  CopyVector(capture.motion.velocity_m_s, args.velocity_m_s);
  CopyVector(capture.motion.rate_rad_s, args.rate_rad_s);
  args.smear_good_px = static_cast<float>(options_.expert().motion().smear_good_px());
  args.smear_max_px = static_cast<float>(options_.expert().motion().smear_max_px());
  return args;
}

SigmaArgs ThermalFuser::UncertaintyArgs(const CaptureConditions& capture, double voxel_m) const {
  const auto squared = [](double value) { return static_cast<float>(value * value); };
  const double resolution_k2 = kUniformVariance * ThermalLayout::kStep_k * ThermalLayout::kStep_k;
  const double drift_k = DriftKelvin(capture.camera, capture.nuc);
  SigmaArgs args{};
  args.noise_k2 = squared(capture.camera.netd_k);
  args.even_k2 = static_cast<float>(drift_k * drift_k + resolution_k2);
  args.place_px2 =
      static_cast<float>(capture.registration_px * capture.registration_px +
                         capture.extrinsic_px * capture.extrinsic_px + kUniformVariance);
  args.voxel_px2_m2 = squared(rectifier_.ideal_camera().fx * voxel_m * std::sqrt(kUniformVariance));
  args.time_s2 = squared(capture.time_sigma_s);
  args.scene_influence = static_cast<float>(capture.camera.scene_influence);
  if (args.scene_influence > 0.0F) args.scene_celsius = static_cast<float>(MeanCelsius(celsius_));
  return args;
}

void ThermalFuser::MakePixels(const PixelRowArgs& args, const CaptureConditions& capture,
                              ThreadPool& pool, FusionReport& report) {
  const CameraModel& camera = rectifier_.ideal_camera();
  const int width = camera.width;
  const int height = camera.height;
  const int tasks = (height + kRowsPerTask - 1) / kRowsPerTask;
  std::atomic<std::int64_t> occluded{0}, smeared{0}, steep{0}, maybe_hidden{0};
  pool.ParallelFor(tasks, [&](int task) {
    const std::span<float> nearest = nearest_m_.Row(task);
    const std::span<float> farthest = farthest_m_.Row(task);
    std::fill(nearest.begin(), nearest.end(), std::numeric_limits<float>::max());
    std::fill(farthest.begin(), farthest.end(), 0.0F);
    const int end = std::min(height, (task + 1) * kRowsPerTask);
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
      row.noise_gain = rectifier_.noise_gain().Row(y).data();
      row.y = static_cast<float>((y - camera.cy) / camera.fy);
      row.smear_s =
          static_cast<float>(sensor_.time_constant_s +
                             sensor_.row_readout_s * RowsFromMiddle(rectifier_.camera(), row.y));
      const auto first = static_cast<std::size_t>(y) * static_cast<std::size_t>(width);
      ThermalPixel* pixels = pixels_.data() + first;
      const PixelRowCounts counts = MakePixelRow(row, pixels, planes_.data() + first);
      occluded += counts.occluded;
      smeared += counts.smeared;
      steep += counts.steep;
      if (capture.near_range != nullptr)
        maybe_hidden += capture.near_range->LeaveOut(y, {pixels, static_cast<std::size_t>(width)});
      for (int x = 0; x < width; ++x) {
        const float depth = pixels[x].depth_m;
        const auto tile = static_cast<std::size_t>(x / kTile);
        farthest[tile] = std::max(farthest[tile], depth);
        if (depth > 0.0F) nearest[tile] = std::min(nearest[tile], depth);
      }
    }
    if (capture.line_of_sight != nullptr) {
      const int first = task * kRowsPerTask;
      const std::span rows(pixels_.data() + static_cast<std::ptrdiff_t>(first) * width,
                           static_cast<std::size_t>((end - first) * width));
      maybe_hidden += capture.line_of_sight->LeaveOut(first, rows);
    }
  });
  report.occluded = occluded;
  report.smeared = smeared;
  report.steep = steep;
  report.maybe_hidden = maybe_hidden;
}

void ThermalFuser::SelectBlocks(const RigidTransform& T_map_thermal, const TsdfVolume& tsdf) {
  const CameraModel& camera = rectifier_.ideal_camera();
  const VoxelGrid& grid = tsdf.grid();
  const float reach_m =
      BlockRadius(grid) +
      static_cast<float>(options_.expert().vertex_distance_vox() * grid.voxel_size_m);
  const BlockTiles tiles(grid, camera, T_map_thermal,
                         {kTile, nearest_m_.width(), nearest_m_.height()});
  const auto surface_passes = [&](int x, int y, float depth_m) {
    return depth_m - reach_m <= farthest_m_.At(x, y) && depth_m + reach_m >= nearest_m_.At(x, y);
  };
  blocks_.clear();
  for (const std::int32_t block : visible_.Find(tsdf, camera, T_map_thermal)) {
    if (tiles.AnyOf(tsdf.block_coordinates(block), surface_passes)) blocks_.push_back(block);
  }
}

FusionKernelArgs ThermalFuser::BlockArgs(const RigidTransform& T_thermal_map,
                                         const TsdfVolume& tsdf) const {
  const CameraModel& camera = rectifier_.ideal_camera();
  FusionKernelArgs args{};
  args.pixels = pixels_.data();
  args.planes = planes_.data();
  args.width = camera.width;
  args.height = camera.height;
  args.fx = static_cast<float>(camera.fx);
  args.fy = static_cast<float>(camera.fy);
  args.cx = static_cast<float>(camera.cx);
  args.cy = static_cast<float>(camera.cy);
  const double voxel_m = tsdf.grid().voxel_size_m;
  const Eigen::Matrix<float, 3, 3, Eigen::RowMajor> axes =
      (T_thermal_map.linear() * voxel_m).cast<float>();
  std::copy_n(axes.data(), 9, args.axes);
  const double max_distance_m = options_.expert().vertex_distance_vox() * voxel_m;
  args.max_distance_m = static_cast<float>(max_distance_m);
  // A distance measured along a normal is at most that along the line of sight, but for noise.
  // Smaller: noisy voxels get no temperature; larger: the kernel looks at more voxels. Not tuned.
  constexpr double kNoiseMargin = 1.25;
  args.max_tsdf_code = static_cast<std::int32_t>(
      TsdfVoxel::kTsdfScale *
      std::min(1.0, kNoiseMargin * max_distance_m / tsdf.truncation_distance_m()));
  args.validate = options_.expert().validation();
  args.keep_bad = options_.expert().keep_bad();
  args.keep_lowest = options_.expert().policy() == LOWEST_GOOD;
  return args;
}

FusionReport ThermalFuser::Fuse(const PosedThermalFrame& posed, const CaptureConditions& capture,
                                const TsdfVolume& tsdf, ThreadPool& pool, ThermalVolume& thermal) {
  const ThermalFrame& frame = posed.frame;
  const RigidTransform& T_map_thermal = posed.T_map_thermal;
  CHECK(frame.valid);
  CHECK(IsRigid(T_map_thermal) && IsRigid(posed.T_map_depth));
  rectifier_.Rectify(frame.temperature_raw,
                     WithoutDrift(frame.scale, corrections_.housing_drift, capture.nuc), apron_,
                     pool, celsius_);
  CastSurface(T_map_thermal, tsdf, pool);
  FusionReport report;
  PixelRowArgs row_args = RowArgs(posed, capture);
  row_args.sigma = UncertaintyArgs(capture, tsdf.grid().voxel_size_m);
  MakePixels(row_args, capture, pool, report);
  SelectBlocks(T_map_thermal, tsdf);

  const RigidTransform T_thermal_map = T_map_thermal.inverse();
  const FusionKernelArgs args = BlockArgs(T_thermal_map, tsdf);
  const MeasurementRecorder recorder(options_, T_map_thermal, args.axes, capture.nuc);
  ++frames_;
  std::atomic<std::int64_t> considered{0}, assigned{0}, dropped{0};
  // A frame updates hundreds of blocks: enough tasks for all threads, few enough to hand out. Not
  // tuned.
  constexpr int kBlocksPerTask = 32;
  const int count = static_cast<int>(blocks_.size());
  pool.ParallelFor((count + kBlocksPerTask - 1) / kBlocksPerTask, [&](int task) {
    FusionKernelCounts counts;
    BlockMeasurements measured;
    std::int64_t task_dropped = 0;
    const int end = std::min(count, (task + 1) * kBlocksPerTask);
    for (int i = task * kBlocksPerTask; i < end; ++i) {
      const std::int32_t block = blocks_[i];
      const Eigen::Vector3f first =
          (T_thermal_map * tsdf.grid().VoxelCentre(tsdf.block_coordinates(block) * kBlockSide))
              .cast<float>();
      measured.count = 0;
      FuseBlock(args,
                {first.data(), &tsdf.voxels(block).front().bits, SigmasOf(thermal, block),
                 &thermal.voxels(block).front().bits},
                counts, thermal.records() != nullptr ? &measured : nullptr);
      if (measured.count > 0) recorder.Record(measured, first, block, thermal);
      // Spread over the frames by the block's number, so that each frame reviews about as many.
      if ((static_cast<std::uint32_t>(block) + frames_) % kFramesBetweenReviews == 0)
        task_dropped += review_.Review(block, tsdf, thermal);
    }
    considered += counts.considered;
    assigned += counts.assigned;
    dropped += task_dropped;
  });
  report.considered = considered;
  report.assigned = assigned;
  report.dropped = dropped;
  return report;
}

std::int64_t ThermalFuser::FinalReview(const TsdfVolume& tsdf, ThermalVolume& thermal,
                                       ThreadPool& pool) const {
  // All blocks of the model, a thousand and more. Not tuned.
  constexpr int kBlocksPerTask = 64;
  std::atomic<std::int64_t> dropped{0};
  const int count = tsdf.block_count();
  pool.ParallelFor((count + kBlocksPerTask - 1) / kBlocksPerTask, [&](int task) {
    const int end = std::min(count, (task + 1) * kBlocksPerTask);
    for (int block = task * kBlocksPerTask; block < end; ++block)
      dropped += review_.Review(block, tsdf, thermal, /*is_final=*/true);
  });
  return dropped;
}

}  // namespace isotherm
