#include "common/simulation/depth_sensor.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "common/frame/frame.h"
#include "common/simulation/noise.h"
#include "common/simulation/simulation_options.pb.h"

namespace isotherm {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;

/// Neighbours on different surfaces whose depth differs by more than this share are an edge.
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
    const auto in = scratch.white.Row(y);
    const auto out = scratch.rows.Row(y);
    for (std::size_t x = 0; x < in.size(); ++x) {
      const std::size_t left = x > 0 ? x - 1 : 1 % in.size();
      const std::size_t right = x + 1 < in.size() ? x + 1 : (x > 0 ? x - 1 : 0);
      out[x] = in[left] + 2.0F * in[x] + in[right];
    }
  }
}

/// The other direction of MakeCorrelatedNoise, pixel by pixel.
float CorrelatedNoise(const Image<float>& rows, int x, int y) {
  constexpr float kNormalize =
      1.0F / 6.0F;  // 1 / (1 + 4 + 1), the root of the sum of squared weights.
  const int above = y > 0 ? y - 1 : std::min(1, rows.height() - 1);
  const int below = y + 1 < rows.height() ? y + 1 : std::max(0, y - 1);
  return (rows.At(x, above) + 2.0F * rows.At(x, y) + rows.At(x, below)) * kNormalize;
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

}  // namespace

DepthSensor::DepthSensor(const CameraModel& camera, const DepthCameraOptions& options)
    : grid_(camera),
      disparity_metres_px_(static_cast<float>(camera.fx * options.baseline_m())),
      step_px_(static_cast<float>(options.disparity_step_px())),
      sigma_px_(static_cast<float>(options.disparity_noise_px())),
      min_depth_m_(static_cast<float>(options.min_depth_m())),
      max_depth_m_(static_cast<float>(options.max_depth_m())),
      grazing_start_cos_(static_cast<float>(std::cos(options.grazing_start_deg() * kDegree))),
      grazing_end_cos_(static_cast<float>(std::cos(options.grazing_end_deg() * kDegree))),
      edge_dropout_(static_cast<float>(options.edge_dropout())),
      depth_scale_(static_cast<float>(options.depth_scale())) {}

Image<std::uint16_t> DepthSensor::Render(const Scene& scene, const RigidTransform& T_world_depth,
                                         std::uint64_t noise_stream, Scratch& scratch) const {
  CastRays(scene, grid_, T_world_depth, scratch.hits);
  FindShadow(scratch.hits, scratch.lit);
  MakeCorrelatedNoise(noise_stream, scratch);
  const CameraView view(scene, T_world_depth);
  const std::uint64_t drop_stream = MixBits(noise_stream);
  Image<std::uint16_t> depth_raw(grid_.width(), grid_.height(), kNoDepth);
  for (int y = 0; y < grid_.height(); ++y) {
    for (int x = 0; x < grid_.width(); ++x) {
      if (scratch.lit.At(x, y) == 0) continue;
      if (IsDropped(scratch.hits, view, x, y, drop_stream)) continue;
      depth_raw.At(x, y) = Measure(scratch.hits.z_m.At(x, y), CorrelatedNoise(scratch.rows, x, y));
    }
  }
  return depth_raw;
}

void DepthSensor::FindShadow(const HitImage& hits, Image<std::uint8_t>& lit) const {
  // Camera and projector share their rows. Seen from the projector, a point is one disparity
  // further left. From right to left the projector must see the points in the same order; one that
  // comes out of order is hidden behind a point that was already passed.
  constexpr float kSameSurfacePx = 0.5F;
  const int width = grid_.width();
  lit.Resize(width, grid_.height());
  for (int y = 0; y < grid_.height(); ++y) {
    float leftmost = std::numeric_limits<float>::infinity();
    for (int x = width - 1; x >= 0; --x) {
      const float z = hits.z_m.At(x, y);
      const bool hit = z < std::numeric_limits<float>::infinity();
      const float column = static_cast<float>(x) - (hit ? disparity_metres_px_ / z : 0.0F);
      lit.At(x, y) = hit && column <= leftmost + kSameSurfacePx ? 1 : 0;
      if (hit) leftmost = std::min(leftmost, column);
    }
  }
}

bool DepthSensor::IsDropped(const HitImage& hits, const CameraView& view, int x, int y,
                            std::uint64_t drop_stream) const {
  const auto counter = static_cast<std::uint64_t>(y) * static_cast<std::uint64_t>(grid_.width()) +
                       static_cast<std::uint64_t>(x);
  const float cosine = view.CosineAt(hits.primitive.At(x, y), grid_.Ray(x, y), hits.z_m.At(x, y));
  float dropped_share = 0.0F;
  if (cosine < grazing_start_cos_) {
    if (cosine <= grazing_end_cos_) return true;
    dropped_share = (grazing_start_cos_ - cosine) / (grazing_start_cos_ - grazing_end_cos_);
  }
  if (edge_dropout_ > 0.0F && IsEdge(hits, x, y)) {
    dropped_share = std::max(dropped_share, edge_dropout_);
  }
  return dropped_share > 0.0F && UniformNoise(drop_stream, counter) < dropped_share;
}

std::uint16_t DepthSensor::Measure(float z_m, float noise) const {
  float disparity_px = disparity_metres_px_ / z_m + sigma_px_ * noise;
  if (step_px_ > 0.0F) disparity_px = std::round(disparity_px / step_px_) * step_px_;
  const float measured_m = disparity_metres_px_ / disparity_px;
  if (!(measured_m >= min_depth_m_ && measured_m <= max_depth_m_)) return kNoDepth;
  const float raw = std::round(measured_m * depth_scale_);
  constexpr float kLargest = static_cast<float>(kNoDepthSaturated - 1);
  return raw <= kLargest ? static_cast<std::uint16_t>(raw) : kNoDepth;
}

}  // namespace isotherm
