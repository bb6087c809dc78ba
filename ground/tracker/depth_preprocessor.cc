#include "ground/tracker/depth_preprocessor.h"

#include <fmt/format.h>

#include <atomic>
#include <cmath>
#include <limits>
#include <vector>

namespace isotherm {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr int kRowsPerTask = 16;

/// Pixels to either side for normals, per pyramid level: about the same patch of surface at each.
constexpr std::array<int, kPyramidLevels> kNormalReach = {3, 2, 1};

void ForRows(ThreadPool& pool, int height, const std::function<void(int)>& row) {
  pool.ParallelFor((height + kRowsPerTask - 1) / kRowsPerTask, [&](int task) {
    const int end = std::min(height, (task + 1) * kRowsPerTask);
    for (int y = task * kRowsPerTask; y < end; ++y) row(y);
  });
}

Image<std::int32_t> MakeRectification(const CameraModel& camera) {
  Image<std::int32_t> source(camera.width, camera.height, -1);
  const CameraModel ideal = camera.WithoutDistortion();
  for (int v = 0; v < camera.height; ++v) {
    for (int u = 0; u < camera.width; ++u) {
      const Eigen::Vector2d pixel = ProjectNormalized(camera, Unproject(ideal, {u, v}));
      const int x = static_cast<int>(std::lround(pixel.x()));
      const int y = static_cast<int>(std::lround(pixel.y()));
      if (source.Contains(x, y)) source.At(u, v) = y * camera.width + x;
    }
  }
  return source;
}

}  // namespace

Status Validate(const PreprocessorOptions& o) {
  if (!(o.min_depth_m() >= 0.0 && o.max_depth_m() > o.min_depth_m() && o.max_depth_m() <= 100.0)) {
    return InvalidArgument(fmt::format(
        "preprocessor: need 0 <= min_depth_m < max_depth_m <= 100 m, got {} m and {} m", o.min_depth_m(),
        o.max_depth_m()));
  }
  if (o.bilateral_radius_px() < 0 || o.bilateral_radius_px() > 8) {
    return InvalidArgument(fmt::format("preprocessor.bilateral_radius_px must be 0..8 pixels, got {}",
                                       o.bilateral_radius_px()));
  }
  if (!(o.bilateral_sigma_px() > 0.0 && o.bilateral_sigma_depth_m() > 0.0 && o.max_depth_step_ratio() > 0.0)) {
    return InvalidArgument(
        "preprocessor: bilateral_sigma_px, bilateral_sigma_depth_m and max_depth_step_ratio must be positive");
  }
  return OkStatus();
}

void BilateralFilter(const Image<float>& depth_m, const PreprocessorOptions& options, ThreadPool& pool,
                     Image<float>& filtered_m) {
  const int width = depth_m.width();
  const int height = depth_m.height();
  const int radius = options.bilateral_radius_px();
  filtered_m.Resize(width, height);
  if (radius == 0) {
    std::copy(depth_m.pixels().begin(), depth_m.pixels().end(), filtered_m.pixels().begin());
    return;
  }
  const auto sigma_px = static_cast<float>(options.bilateral_sigma_px());
  // The biweight with tau = sqrt(7) sigma has the variance of a Gaussian with that sigma.
  const auto tau_at_1m = static_cast<float>(options.bilateral_sigma_depth_m() * std::sqrt(7.0));
  ForRows(pool, height, [&](int y) {
    thread_local std::vector<float> sum, weight_sum, inverse_tau2;
    const auto n = static_cast<std::size_t>(width);
    sum.assign(n, 0.0F);
    weight_sum.assign(n, 0.0F);
    inverse_tau2.resize(n);
    const float* centre = depth_m.Row(y).data();
    for (int x = 0; x < width; ++x) {
      const float tau = tau_at_1m * centre[x] * centre[x];
      inverse_tau2[x] = 1.0F / std::max(tau * tau, 1e-12F);
    }
    for (int dy = -radius; dy <= radius; ++dy) {
      if (y + dy < 0 || y + dy >= height) continue;
      const float* row = depth_m.Row(y + dy).data();
      for (int dx = -radius; dx <= radius; ++dx) {
        const float spatial =
            std::exp(-static_cast<float>(dx * dx + dy * dy) / (2.0F * sigma_px * sigma_px));
        const int begin = std::max(0, -dx);
        const int end = std::min(width, width - dx);
        for (int x = begin; x < end; ++x) {
          const float difference = row[x + dx] - centre[x];
          const float falloff = std::max(0.0F, 1.0F - difference * difference * inverse_tau2[x]);
          const float w = spatial * falloff * falloff;
          sum[x] += w * row[x + dx];
          weight_sum[x] += w;
        }
      }
    }
    float* out = filtered_m.Row(y).data();
    for (int x = 0; x < width; ++x) out[x] = centre[x] > 0.0F ? sum[x] / weight_sum[x] : 0.0F;
  });
}

void HalveDepth(const Image<float>& depth_m, float max_step_ratio, ThreadPool& pool, Image<float>& half_m) {
  half_m.Resize(depth_m.width() / 2, depth_m.height() / 2);
  ForRows(pool, half_m.height(), [&](int y) {
    const float* upper = depth_m.Row(2 * y).data();
    const float* lower = depth_m.Row(2 * y + 1).data();
    float* out = half_m.Row(y).data();
    for (int x = 0; x < half_m.width(); ++x) {
      const std::array<float, 4> z = {upper[2 * x], upper[2 * x + 1], lower[2 * x], lower[2 * x + 1]};
      float nearest = std::numeric_limits<float>::infinity();
      for (const float value : z) {
        if (value > 0.0F) nearest = std::min(nearest, value);
      }
      float sum = 0.0F;
      float count = 0.0F;
      for (const float value : z) {
        if (value > 0.0F && value - nearest <= max_step_ratio * nearest) {
          sum += value;
          count += 1.0F;
        }
      }
      out[x] = count > 0.0F ? sum / count : 0.0F;
    }
  });
}

void MakeSurfaceMaps(const Image<float>& depth_m, const CameraModel& camera, int reach, float max_step_ratio,
                     ThreadPool& pool, SurfaceMaps& maps) {
  const int width = depth_m.width();
  const int height = depth_m.height();
  maps.Resize(width, height);
  const auto inverse_fx = static_cast<float>(1.0 / camera.fx);
  const auto inverse_fy = static_cast<float>(1.0 / camera.fy);
  const auto cx = static_cast<float>(camera.cx);
  const auto cy = static_cast<float>(camera.cy);
  const float max_step = max_step_ratio * static_cast<float>(reach);

  ForRows(pool, height, [&](int y) {
    const float* z = depth_m.Row(y).data();
    const auto unproject = [&](int u, int v, float depth) {
      return Eigen::Vector3f((static_cast<float>(u) - cx) * inverse_fx * depth,
                             (static_cast<float>(v) - cy) * inverse_fy * depth, depth);
    };
    const auto store = [&](int x, const Eigen::Vector3f& p, const Eigen::Vector3f& n) {
      maps.vx.At(x, y) = p.x();
      maps.vy.At(x, y) = p.y();
      maps.vz.At(x, y) = p.z();
      maps.nx.At(x, y) = n.x();
      maps.ny.At(x, y) = n.y();
      maps.nz.At(x, y) = n.z();
    };
    const Eigen::Vector3f nothing = Eigen::Vector3f::Constant(kNan);
    const bool row_inside = y >= reach && y + reach < height;
    for (int x = 0; x < width; ++x) {
      const float depth = z[x];
      if (!row_inside || x < reach || x + reach >= width || !(depth > 0.0F)) {
        store(x, nothing, nothing);
        continue;
      }
      const float left = z[x - reach];
      const float right = z[x + reach];
      const float up = depth_m.At(x, y - reach);
      const float down = depth_m.At(x, y + reach);
      const float limit = max_step * depth;
      const bool smooth = std::abs(left - depth) < limit && std::abs(right - depth) < limit &&
                          std::abs(up - depth) < limit && std::abs(down - depth) < limit;
      if (!smooth) {
        store(x, nothing, nothing);
        continue;
      }
      const Eigen::Vector3f along_x = unproject(x + reach, y, right) - unproject(x - reach, y, left);
      const Eigen::Vector3f along_y = unproject(x, y + reach, down) - unproject(x, y - reach, up);
      // y x x points towards the camera (x right, y down, z forward).
      store(x, unproject(x, y, depth), along_y.cross(along_x).normalized());
    }
  });
}

DepthPreprocessor::DepthPreprocessor(const PreprocessorOptions& options, const CameraModel& depth_camera)
    : options_(options), camera_(depth_camera.WithoutDistortion()) {
  if (depth_camera.HasDistortion()) rectification_ = MakeRectification(depth_camera);
  prepared_.camera = camera_;
}

void DepthPreprocessor::ToMetres(const DepthFrame& frame, ThreadPool& pool) {
  prepared_.depth_m.Resize(camera_.width, camera_.height);
  const auto metres_per_unit = static_cast<float>(1.0 / frame.depth_scale);
  const auto min_depth = static_cast<float>(options_.min_depth_m());
  const auto max_depth = static_cast<float>(options_.max_depth_m());
  std::atomic<int> valid{0};
  ForRows(pool, camera_.height, [&](int y) {
    float* out = prepared_.depth_m.Row(y).data();
    const std::uint16_t* raw = frame.depth_raw.Row(y).data();
    const std::int32_t* source = rectification_.empty() ? nullptr : rectification_.Row(y).data();
    int count = 0;
    for (int x = 0; x < camera_.width; ++x) {
      const std::uint16_t value =
          source == nullptr ? raw[x] : (source[x] < 0 ? kNoDepth : frame.depth_raw.data()[source[x]]);
      const float depth = static_cast<float>(value) * metres_per_unit;
      const bool good = value != kNoDepthSaturated && depth >= min_depth && depth <= max_depth;
      out[x] = good && value != kNoDepth ? depth : 0.0F;
      count += out[x] > 0.0F ? 1 : 0;
    }
    valid += count;
  });
  prepared_.valid_pixels = valid;
}

const PreparedDepth& DepthPreprocessor::Process(const DepthFrame& frame, ThreadPool& pool) {
  CHECK(frame.depth_raw.width() == camera_.width && frame.depth_raw.height() == camera_.height);
  ToMetres(frame, pool);
  const auto step_ratio = static_cast<float>(options_.max_depth_step_ratio());
  BilateralFilter(prepared_.depth_m, options_, pool, filtered_m_[0]);
  for (int level = 0; level < kPyramidLevels; ++level) {
    if (level > 0) HalveDepth(filtered_m_[level - 1], step_ratio, pool, filtered_m_[level]);
    MakeSurfaceMaps(filtered_m_[level], camera_.Downscaled(level), kNormalReach[level], step_ratio, pool,
                    prepared_.maps[level]);
  }
  return prepared_;
}

}  // namespace isotherm
