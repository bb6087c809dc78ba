#include "common/simulation/depth_sensor.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "common/base/noise.h"
#include "common/base/units.h"
#include "common/frame/frame.h"
#include "common/simulation/depth_defects.h"
#include "common/simulation/simulation_options.pb.h"

namespace isotherm {
namespace {

/// Neighbours on different surfaces whose depth differs by more than this fraction are an edge.
constexpr float kEdgeStepRatio = 0.015F;

/// Noise that neighbours share: the correlation window of a real sensor covers several pixels.
/// Weights 1 2 1 in both directions, scaled to keep a standard deviation of 1.
void MakeCorrelatedNoise(std::uint64_t stream, DepthSensor::Scratch& scratch) {
  const int width = scratch.hits.z_m.width(), height = scratch.hits.z_m.height();
  scratch.white.Resize(width, height);
  scratch.rows.Resize(width, height);
  std::uint64_t counter = 0;
  for (float& value : scratch.white.pixels()) value = NormalNoise(stream, counter++);
  for (int y = 0; y < height; ++y) {
    const float* const in = scratch.white.Row(y).data();
    float* const out = scratch.rows.Row(y).data();
    for (int x = 1; x + 1 < width; ++x) out[x] = in[x - 1] + 2.0F * in[x] + in[x + 1];
    // Mirrored at the border.
    const int last = width - 1, before_last = std::max(0, width - 2), second = std::min(1, last);
    out[0] = 2.0F * in[0] + 2.0F * in[second];
    out[last] = 2.0F * in[last] + 2.0F * in[before_last];
  }
}

/// The other direction of MakeCorrelatedNoise, row by row.
void CorrelateColumns(const Image<float>& rows, int y, std::vector<float>& noise) {
  constexpr float kNormalize =
      1.0F / 6.0F;  // 1 / (1 + 4 + 1), the root of the sum of squared weights.
  const int last = rows.height() - 1;
  const float* const above = rows.Row(y > 0 ? y - 1 : std::min(1, last)).data();
  const float* const middle = rows.Row(y).data();
  const float* const below = rows.Row(y < last ? y + 1 : std::max(0, last - 1)).data();
  noise.resize(static_cast<std::size_t>(rows.width()));
  float* const out = noise.data();
  for (int x = 0; x < rows.width(); ++x) {
    out[x] = (above[x] + 2.0F * middle[x] + below[x]) * kNormalize;
  }
}

/// std::round is a library call on processors without SSE4.1 in the build's baseline.
float RoundPositive(float value) {
  return static_cast<float>(static_cast<std::int32_t>(value + 0.5F));
}

bool IsEdge(const HitImage& hits, int x, int y) {
  const float z = hits.z_m.At(x, y);
  const std::int16_t primitive = hits.primitive.At(x, y);
  const auto differs = [&](int nx, int ny) {
    return hits.z_m.Contains(nx, ny) && hits.primitive.At(nx, ny) != primitive &&
           !(std::abs(hits.z_m.At(nx, ny) - z) <= kEdgeStepRatio * z);
  };
  return differs(x - 1, y) || differs(x + 1, y) || differs(x, y - 1) || differs(x, y + 1);
}

/// Factors over the image: 1 in its middle, 1 + `in_corners` in its corners.
Image<float> MakeSwelling(const CameraModel& camera, double in_corners) {
  Image<float> factors(camera.width, camera.height);
  const double middle_x = 0.5 * (camera.width - 1), middle_y = 0.5 * (camera.height - 1);
  const double corner_px = std::max(1.0, std::hypot(middle_x, middle_y));
  for (int y = 0; y < camera.height; ++y)
    for (int x = 0; x < camera.width; ++x) {
      const double radius = std::hypot(x - middle_x, y - middle_y) / corner_px;
      factors.At(x, y) = static_cast<float>(1.0 + in_corners * radius * radius);
    }
  return factors;
}

}  // namespace

DepthSensor::DepthSensor(const CameraModel& camera, const SimulatedDepthOptions& options)
    : grid_(camera),
      disparity_metres_px_(static_cast<float>(camera.fx * options.expert().baseline_m())),
      step_px_(static_cast<float>(options.expert().disparity_step_px())),
      sigma_px_(static_cast<float>(options.expert().disparity_noise_px())),
      min_depth_m_(static_cast<float>(options.expert().min_depth_m())),
      max_depth_m_(static_cast<float>(options.expert().max_depth_m())),
      grazing_start_cos_(
          static_cast<float>(std::cos(options.expert().grazing_start_deg() * kRadPerDeg))),
      grazing_end_cos_(
          static_cast<float>(std::cos(options.expert().grazing_end_deg() * kRadPerDeg))),
      edge_dropout_(static_cast<float>(options.expert().edge_dropout())),
      depth_scale_(static_cast<float>(options.expert().depth_scale())),
      flying_fraction_(options.expert().flying_fraction()),
      readout_s_(options.expert().readout_s()),
      swelling_(MakeSwelling(camera, options.expert().corner_swelling())) {}

Image<std::uint16_t> DepthSensor::Render(const Scene& scene, const RigidTransform& T_world_depth,
                                         std::uint64_t noise_stream, Scratch& scratch) const {
  return RenderMoving(
      scene, [&](double) { return T_world_depth; }, 1.0, noise_stream, scratch);
}

Image<std::uint16_t> DepthSensor::RenderMoving(const Scene& scene, const PoseAfter& T_world_depth,
                                               double stretch, std::uint64_t noise_stream,
                                               Scratch& scratch) const {
  const int height = grid_.height();
  // Rows that are taken from one pose.
  const int strip = readout_s_ > 0.0 ? RayGrid::kTileHeight : height;
  const auto pose_of_strip = [&](int row) {
    const double middle = row + 0.5 * std::min(strip, height - row);
    return T_world_depth(readout_s_ * (middle / height - 0.5));
  };
  if (readout_s_ > 0.0) {
    CastRays(scene, grid_, pose_of_strip, scratch.hits);
  } else {
    CastRays(scene, grid_, T_world_depth(0.0), scratch.hits);
  }
  FindShadow(scratch.hits, scratch.lit);
  MakeCorrelatedNoise(noise_stream, scratch);
  const std::uint64_t drop_stream = MixBits(noise_stream);
  Image<std::uint16_t> depth_raw(grid_.width(), height, kNoDepth);
  for (int first = 0; first < height; first += strip) {
    const CameraView view(scene, pose_of_strip(first));
    for (int y = first; y < std::min(first + strip, height); ++y) {
      CorrelateColumns(scratch.rows, y, scratch.noise);
      MeasureRow(y, static_cast<float>(stretch), scratch);
      for (int x = 0; x < grid_.width(); ++x) {
        if (scratch.lit.At(x, y) == 0) continue;
        if (IsDropped(scratch.hits, view, x, y, drop_stream)) continue;
        depth_raw.At(x, y) = static_cast<std::uint16_t>(scratch.raw[static_cast<std::size_t>(x)]);
      }
    }
  }
  if (flying_fraction_ > 0.0) AddFlyingPixels(flying_fraction_, MixBits(drop_stream), depth_raw);
  return depth_raw;
}

void DepthSensor::FindShadow(const HitImage& hits, Image<std::uint8_t>& lit) const {
  // Camera and projector share their rows. Seen from the projector, a point is one disparity
  // further left. From right to left the projector must see the points in the same order; one that
  // comes out of order is hidden behind a point that was already passed.
  constexpr float kSameSurface_px = 0.5F;
  const int width = grid_.width();
  lit.Resize(width, grid_.height());
  for (int y = 0; y < grid_.height(); ++y) {
    float leftmost = std::numeric_limits<float>::infinity();
    for (int x = width - 1; x >= 0; --x) {
      const float z = hits.z_m.At(x, y);
      const bool hit = z < std::numeric_limits<float>::infinity();
      const float column = static_cast<float>(x) - (hit ? disparity_metres_px_ / z : 0.0F);
      lit.At(x, y) = hit && column <= leftmost + kSameSurface_px ? 1 : 0;
      if (hit) leftmost = std::min(leftmost, column);
    }
  }
}

bool DepthSensor::IsDropped(const HitImage& hits, const CameraView& view, int x, int y,
                            std::uint64_t drop_stream) const {
  const auto counter = static_cast<std::uint64_t>(y) * static_cast<std::uint64_t>(grid_.width()) +
                       static_cast<std::uint64_t>(x);
  const float cosine = view.CosineAt(hits.primitive.At(x, y), grid_.Ray(x, y), hits.z_m.At(x, y));
  float dropped_fraction = 0.0F;
  if (cosine < grazing_start_cos_) {
    if (cosine <= grazing_end_cos_) return true;
    dropped_fraction = (grazing_start_cos_ - cosine) / (grazing_start_cos_ - grazing_end_cos_);
  }
  if (edge_dropout_ > 0.0F && IsEdge(hits, x, y)) {
    dropped_fraction = std::max(dropped_fraction, edge_dropout_);
  }
  return dropped_fraction > 0.0F && UniformNoise(drop_stream, counter) < dropped_fraction;
}

void DepthSensor::MeasureRow(int y, float stretch, Scratch& scratch) const {
  // Without branches and member accesses inside, so that the divisions become SIMD code.
  constexpr float kMaxRaw = static_cast<float>(kNoDepthSaturated - 1);
  constexpr float kUnquantised = 1e-4F;  // A step far below any noise.
  constexpr float kMax_px = 1e5F;        // Nearer than any camera; keeps steps within 32 bits.
  const float disparity_metres_px = disparity_metres_px_, sigma_px = sigma_px_;
  // The baseline has changed, but not what the camera knows of it.
  const float known_metres_px = stretch * disparity_metres_px;
  const float step_px = step_px_ > 0.0F ? step_px_ : kUnquantised;
  const float min_m = min_depth_m_, max_m = max_depth_m_, scale = depth_scale_;
  const std::span<const float> z_m = scratch.hits.z_m.Row(y);
  scratch.raw.resize(z_m.size());
  const float* const z = z_m.data();
  const float* const swelling = swelling_.Row(y).data();
  const float* const noise = scratch.noise.data();
  std::int32_t* const out = scratch.raw.data();
  const int width = static_cast<int>(z_m.size());
  for (int x = 0; x < width; ++x) {
    const float true_px = disparity_metres_px / z[x];
    const float noisy_px = std::min(true_px, kMax_px) + sigma_px * noise[x];
    const float measured_m =
        swelling[x] * known_metres_px / (RoundPositive(noisy_px / step_px) * step_px);
    const float raw = measured_m * scale;
    const bool good = (measured_m >= min_m) & (measured_m <= max_m) & (raw <= kMaxRaw);
    out[x] = static_cast<std::int32_t>(RoundPositive(good ? raw : 0.0F));
  }
}

}  // namespace isotherm
