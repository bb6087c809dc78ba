#include "ground/surface/depth_preprocessor.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <tuple>
#include <utility>
#include <vector>

#include "common/base/units.h"
#include "ground/surface/filter_kernel.h"
#include "ground/surface/surface_map_kernel.h"

namespace isotherm {
namespace {

/// 480 rows make 30 tasks for a handful of threads. Not tuned.
constexpr int kRowsPerTask = 16;
/// The rows of one window are kept in an array of this size; its cost grows with the square.
constexpr int kMaxBilateralRadius = 8;

/// Pixels to either side for normals, per pyramid level: about the same patch of surface at each.
constexpr std::array<int, kPyramidLevels> kNormalReach = {3, 2, 1};

Image<std::int32_t> MakeRectification(const CameraModel& camera) {
  Image<std::int32_t> source(camera.width, camera.height, -1);
  const CameraModel ideal = camera.WithoutDistortion();
  for (int v = 0; v < camera.height; ++v) {
    for (int u = 0; u < camera.width; ++u) {
      const Eigen::Vector2d pixel = ProjectNormalized(camera, Unproject(ideal, {u, v}));
      // The nearest pixel: depth must not be interpolated across an edge, where it would lie on
      // neither surface.
      const int x = static_cast<int>(std::lround(pixel.x()));
      const int y = static_cast<int>(std::lround(pixel.y()));
      if (source.Contains(x, y)) source.At(u, v) = y * camera.width + x;
    }
  }
  return source;
}

/// Layers as DepthPreprocessor keeps them.
std::vector<Image<float>> MakeBiasSteps(const CameraModel& camera, const DepthBias& bias) {
  if (bias.empty()) return {};
  CHECK(Validate(bias).ok());
  std::vector<Image<float>> steps(bias.distances_m.size(),
                                  Image<float>(camera.width, camera.height));
  const CameraModel ideal = camera.WithoutDistortion();
  const auto fraction = [](double pixel, int size) { return pixel / std::max(1, size - 1); };
  for (int v = 0; v < camera.height; ++v)
    for (int u = 0; u < camera.width; ++u) {
      const Eigen::Vector2d raw = ProjectNormalized(camera, Unproject(ideal, {u, v}));
      const double x = fraction(raw.x(), camera.width), y = fraction(raw.y(), camera.height);
      double before = 0.0;
      for (std::size_t k = 0; k < steps.size(); ++k) {
        const double multiplier = bias.InLayer(static_cast<int>(k), x, y);
        steps[k].At(u, v) = static_cast<float>(multiplier - before);
        before = multiplier;
      }
    }
  return steps;
}

}  // namespace

Status Validate(const PreprocessorOptions& o) {
  for (const auto& [name, is_set, depth_m] :
       {std::tuple("min_depth_m", o.expert().has_min_depth_m(), o.expert().min_depth_m()),
        std::tuple("max_depth_m", o.expert().has_max_depth_m(), o.expert().max_depth_m())}) {
    if (is_set && !(depth_m >= 0.0 && depth_m <= 100.0))
      return InvalidArgument(
          fmt::format("preprocessor.expert.{} must be 0..100 m, got {}", name, depth_m));
  }
  if (o.expert().has_min_depth_m() && o.expert().has_max_depth_m())
    ISOTHERM_RETURN_IF_ERROR(CheckRange(o, DepthSensorModel()));
  return Validate(o.expert());
}

Status Validate(const PreprocessorExpertOptions& o) {
  if (o.bilateral_radius_px() < 0 || o.bilateral_radius_px() > kMaxBilateralRadius) {
    return InvalidArgument(
        fmt::format("preprocessor.expert.bilateral_radius_px must be 0..{} pixels, got {}",
                    kMaxBilateralRadius, o.bilateral_radius_px()));
  }
  if (!(o.bilateral_sigma_px() > 0.0 && o.max_surface_angle_deg() > 0.0 &&
        o.max_surface_angle_deg() < 90.0)) {
    return InvalidArgument(fmt::format(
        "preprocessor.expert: bilateral_sigma_px must be positive and max_surface_angle_deg "
        "between 0 and 90, got {} px and {} degrees",
        o.bilateral_sigma_px(), o.max_surface_angle_deg()));
  }
  return OkStatus();
}

DepthRange RangeOf(const PreprocessorOptions& o, const DepthSensorModel& sensor) {
  return {.min_m = o.expert().has_min_depth_m() ? o.expert().min_depth_m() : sensor.min_depth_m,
          .max_m = o.expert().has_max_depth_m() ? o.expert().max_depth_m() : sensor.max_depth_m};
}

Status CheckRange(const PreprocessorOptions& o, const DepthSensorModel& sensor) {
  const DepthRange range = RangeOf(o, sensor);
  if (range.min_m < range.max_m) return OkStatus();
  return InvalidArgument(fmt::format(
      "preprocessor.expert: need min_depth_m < max_depth_m, got {} m and {} m (what is not set "
      "is the depth camera's)",
      range.min_m, range.max_m));
}

bool IsFullOfHoles(const Image<float>& depth_m) {
  // No period of a pattern of holes shares a factor with it.
  constexpr int kEveryRow = 11;
  // Of a full image it is a few percent, at the borders of surfaces; of one that lacks every tenth
  // pixel at random 19 %.
  constexpr double kManyBesideGaps = 0.2;
  GapCount sum;
  for (int y = 0; y + 1 < depth_m.height(); y += kEveryRow) {
    const GapCount row =
        CountGaps(depth_m.Row(y).data(), depth_m.Row(y + 1).data(), depth_m.width());
    sum.pixels += row.pixels;
    sum.beside_gap += row.beside_gap;
  }
  return sum.beside_gap > kManyBesideGaps * sum.pixels;
}

void FillHoles(const Image<float>& depth_m, float max_step_ratio, float noise_at_1m,
               ThreadPool& pool, Image<float>& filled_m) {
  // Holes of two pixels are filled from what is around them; larger ones are no sampling pattern
  // but something that gives no return.
  constexpr int kRadius = 2;
  constexpr int kSide = 2 * kRadius + 1;
  const int height = depth_m.height();
  filled_m.Resize(depth_m.width(), height);
  pool.ParallelForRows(height, kRowsPerTask, [&](int y) {
    std::array<const float*, kSide> rows{};
    for (int k = 0; k < kSide; ++k) {
      const int row = y + k - kRadius;
      rows[k] = row >= 0 && row < height ? depth_m.Row(row).data() : nullptr;
    }
    FillRow({rows.data(), kRadius, depth_m.width(), max_step_ratio * (kSide - 1), noise_at_1m},
            filled_m.Row(y));
  });
}

void BilateralFilter(const Image<float>& depth_m, const PreprocessorExpertOptions& options,
                     double noise_at_1m, ThreadPool& pool, Image<float>& filtered_m) {
  const int width = depth_m.width();
  const int height = depth_m.height();
  const int radius = options.bilateral_radius_px();
  filtered_m.Resize(width, height);
  if (radius == 0) {
    std::copy(depth_m.pixels().begin(), depth_m.pixels().end(), filtered_m.pixels().begin());
    return;
  }
  const double sigma_px = options.bilateral_sigma_px();
  const int side = 2 * radius + 1;
  std::vector<float> spatial;
  for (int dy = -radius; dy <= radius; ++dy) {
    for (int dx = -radius; dx <= radius; ++dx) {
      spatial.push_back(
          static_cast<float>(std::exp(-(dx * dx + dy * dy) / (2.0 * sigma_px * sigma_px))));
    }
  }
  // The biweight with tau = sqrt(7) sigma has the variance of a Gaussian with that sigma.
  const auto tau_at_1m = static_cast<float>(noise_at_1m * std::sqrt(7.0));
  pool.ParallelForRows(height, kRowsPerTask, [&](int y) {
    std::array<const float*, 2 * kMaxBilateralRadius + 1> rows{};
    for (int k = 0; k < side; ++k) {
      const int row = y + k - radius;
      rows[k] = row >= 0 && row < height ? depth_m.Row(row).data() : nullptr;
    }
    BilateralRow({rows.data(), spatial.data(), radius, width, tau_at_1m}, filtered_m.Row(y));
  });
}

float StepPerPixel(const CameraModel& camera, double angle_deg) {
  return static_cast<float>(std::tan(angle_deg * kRadPerDeg) / std::min(camera.fx, camera.fy));
}

void HalveDepth(const Image<float>& depth_m, float max_step_ratio, ThreadPool& pool,
                Image<float>& half_m) {
  half_m.Resize(depth_m.width() / 2, depth_m.height() / 2);
  pool.ParallelForRows(half_m.height(), kRowsPerTask, [&](int y) {
    HalfRow({depth_m.Row(2 * y).data(), depth_m.Row(2 * y + 1).data(), max_step_ratio},
            half_m.Row(y));
  });
}

void MakeSurfaceMaps(const Image<float>& depth_m, const CameraModel& camera, const NormalRule& rule,
                     ThreadPool& pool, SurfaceMaps& maps) {
  maps.Resize(depth_m.width(), depth_m.height());
  const SurfaceMapArgs args{&depth_m,
                            static_cast<float>(camera.fx),
                            static_cast<float>(camera.fy),
                            static_cast<float>(camera.cx),
                            static_cast<float>(camera.cy),
                            rule.reach_px,
                            rule.max_step_ratio * static_cast<float>(rule.reach_px),
                            rule.noise_at_1m};
  pool.ParallelForRows(depth_m.height(), kRowsPerTask,
                       [&](int y) { SurfaceMapRow(args, y, maps); });
}

DepthPreprocessor::DepthPreprocessor(const PreprocessorOptions& options,
                                     const CameraModel& depth_camera,
                                     const DepthSensorModel& sensor)
    : options_(options),
      range_(RangeOf(options, sensor)),
      noise_at_1m_m_(sensor.noise_at_1m_m),
      camera_(depth_camera.WithoutDistortion()),
      bias_distances_m_(sensor.bias.distances_m),
      bias_steps_(MakeBiasSteps(depth_camera, sensor.bias)) {
  if (depth_camera.HasDistortion()) rectification_ = MakeRectification(depth_camera);
  prepared_.camera = camera_;
  prepared_.noise_at_1m = static_cast<float>(sensor.noise_at_1m_m);
}

void DepthPreprocessor::ToMetres(const DepthFrame& frame, ThreadPool& pool) {
  prepared_.depth_m.Resize(camera_.width, camera_.height);
  const Image<std::uint16_t>* raw = &frame.depth_raw;
  if (!rectification_.empty()) {
    rectified_raw_.Resize(camera_.width, camera_.height);
    pool.ParallelForRows(camera_.height, kRowsPerTask, [&](int y) {
      const std::span<const std::int32_t> source = rectification_.Row(y);
      std::transform(source.begin(), source.end(), rectified_raw_.Row(y).begin(),
                     [&](std::int32_t i) { return i < 0 ? kNoDepth : frame.depth_raw.data()[i]; });
    });
    raw = &rectified_raw_;
  }
  const auto metres_per_unit = static_cast<float>(1.0 / frame.depth_scale);
  const auto min_depth = static_cast<float>(range_.min_m);
  const auto max_depth = static_cast<float>(range_.max_m);
  std::atomic<int> valid{0};
  pool.ParallelForRows(camera_.height, kRowsPerTask, [&](int y) {
    valid += MetresRow({raw->Row(y).data(), metres_per_unit, min_depth, max_depth},
                       prepared_.depth_m.Row(y));
    if (!bias_steps_.empty()) CorrectBias(y);
  });
  prepared_.valid_pixels = valid;
}

void DepthPreprocessor::CorrectBias(int y) {
  constexpr int kMaxLayers = DepthBias::kMaxDistances;
  const std::size_t layers = bias_steps_.size();
  std::array<const float*, kMaxLayers> steps{};
  std::array<float, kMaxLayers> from_m{}, per_m{};
  for (std::size_t k = 0; k < layers; ++k) {
    steps[k] = bias_steps_[k].Row(y).data();
    if (k == 0) continue;
    from_m[k] = bias_distances_m_[k - 1];
    per_m[k] = 1.0F / (bias_distances_m_[k] - bias_distances_m_[k - 1]);
  }
  const std::span<float> depth_m = prepared_.depth_m.Row(y);
  for (std::size_t x = 0; x < depth_m.size(); ++x) {
    const float measured_m = depth_m[x];
    float multiplier = steps[0][x];
    for (std::size_t k = 1; k < layers; ++k) {
      const float share = std::clamp((measured_m - from_m[k]) * per_m[k], 0.0F, 1.0F);
      multiplier += share * steps[k][x];
    }
    depth_m[x] = measured_m * multiplier;
  }
}

const PreparedDepth& DepthPreprocessor::Process(const DepthFrame& frame, ThreadPool& pool) {
  CHECK(frame.depth_raw.width() == camera_.width && frame.depth_raw.height() == camera_.height);
  ToMetres(frame, pool);
  // Only then: filling costs time, and the holes of a sound image are where nothing was seen.
  if (IsFullOfHoles(prepared_.depth_m)) {
    FillHoles(prepared_.depth_m, StepPerPixel(camera_, options_.expert().max_surface_angle_deg()),
              prepared_.noise_at_1m, pool, filled_m_);
    std::swap(prepared_.depth_m, filled_m_);
  }
  BilateralFilter(prepared_.depth_m, options_.expert(), noise_at_1m_m_, pool, filtered_m_[0]);
  float finer_step = 0.0F;
  for (int level = 0; level < kPyramidLevels; ++level) {
    // With the step of the level that it is made of: pixels are averaged there.
    if (level > 0) HalveDepth(filtered_m_[level - 1], finer_step, pool, filtered_m_[level]);
    const CameraModel camera = camera_.Downscaled(level);
    const float step = StepPerPixel(camera, options_.expert().max_surface_angle_deg());
    MakeSurfaceMaps(filtered_m_[level], camera, {kNormalReach[level], step, prepared_.noise_at_1m},
                    pool, prepared_.maps[level]);
    finer_step = step;
  }
  return prepared_;
}

}  // namespace isotherm
