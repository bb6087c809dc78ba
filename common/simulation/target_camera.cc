#include "common/simulation/target_camera.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "common/base/noise.h"
#include "common/frame/frame.h"
#include "common/frame/gaussian_blur.h"

namespace isotherm {
namespace {

/// Rays per pixel and direction where the image is uneven: an edge is then off by less than a
/// thousandth of a pixel, averaged along a hole's rim.
constexpr int kRaysPerSide = 6;

/// Marks the pixels whose own or neighbouring middles meet something else.
Image<std::uint8_t> FindUneven(const Image<BoardSurface>& surfaces) {
  Image<std::uint8_t> uneven(surfaces.width(), surfaces.height(), 0);
  for (int y = 0; y < surfaces.height(); ++y) {
    for (int x = 0; x < surfaces.width(); ++x) {
      for (const auto& [nx, ny] : {std::pair(x + 1, y), std::pair(x, y + 1)}) {
        if (!surfaces.Contains(nx, ny) || surfaces.At(nx, ny) == surfaces.At(x, y)) continue;
        for (int dy = -1; dy <= 1; ++dy) {
          for (int dx = -1; dx <= 1; ++dx) {
            for (const auto& [ux, uy] : {std::pair(x + dx, y + dy), std::pair(nx + dx, ny + dy)})
              if (uneven.Contains(ux, uy)) uneven.At(ux, uy) = 1;
          }
        }
      }
    }
  }
  return uneven;
}

/// Noise that neighbours share, standard deviation 1, as a correlation window of several pixels
/// makes it.
Image<float> SharedNoise(int width, int height, std::uint64_t stream) {
  constexpr float kNormalize = 8.0F / 3.0F;  // Weights 1 2 1, over 4, twice.
  Image<float> noise(width, height), scratch;
  std::uint64_t counter = 0;
  for (float& value : noise.pixels()) value = kNormalize * NormalNoise(stream, counter++);
  const std::vector<float> weights = {0.5F, 0.25F};
  Blur(weights, noise, scratch);
  return noise;
}

}  // namespace

TargetCamera::TargetCamera(const CameraModel& camera, const TargetCameraOptions& options)
    : camera_(camera),
      options_(options),
      corners_(camera.width + 1, camera.height + 1, Eigen::Vector2d::Zero()) {
  for (int y = 0; y <= camera.height; ++y) {
    for (int x = 0; x <= camera.width; ++x)
      corners_.At(x, y) = Unproject(camera, {x - 0.5, y - 0.5});
  }
}

BoardHit TargetCamera::HitAt(const PerforatedBoard& board, const RigidTransform& T_board_camera,
                             int x, int y, double right, double down) const {
  // Within a pixel the lens is as good as linear.
  const Eigen::Vector2d ray =
      (1.0 - down) * ((1.0 - right) * corners_.At(x, y) + right * corners_.At(x + 1, y)) +
      down * ((1.0 - right) * corners_.At(x, y + 1) + right * corners_.At(x + 1, y + 1));
  return CastAtBoard(board, T_board_camera.translation(),
                     T_board_camera.linear() * ray.homogeneous());
}

double TargetCamera::MeanOverPixel(const PerforatedBoard& board,
                                   const RigidTransform& T_board_camera, int x, int y,
                                   const Shade& shade) const {
  double sum = 0.0;
  for (int j = 0; j < kRaysPerSide; ++j) {
    for (int i = 0; i < kRaysPerSide; ++i) {
      sum += shade(
          HitAt(board, T_board_camera, x, y, (i + 0.5) / kRaysPerSide, (j + 0.5) / kRaysPerSide));
    }
  }
  return sum / (kRaysPerSide * kRaysPerSide);
}

Image<float> TargetCamera::Render(const PerforatedBoard& board,
                                  const RigidTransform& T_camera_board, const Shade& shade) const {
  const RigidTransform T_board_camera = T_camera_board.inverse();
  Image<float> values(camera_.width, camera_.height), scratch;
  Image<BoardSurface> surfaces(camera_.width, camera_.height);
  for (int y = 0; y < camera_.height; ++y) {
    for (int x = 0; x < camera_.width; ++x) {
      const BoardHit hit = HitAt(board, T_board_camera, x, y, 0.5, 0.5);
      surfaces.At(x, y) = hit.surface;
      values.At(x, y) = static_cast<float>(shade(hit));
    }
  }
  const Image<std::uint8_t> uneven = FindUneven(surfaces);
  for (int y = 0; y < camera_.height; ++y) {
    for (int x = 0; x < camera_.width; ++x) {
      if (uneven.At(x, y) != 0)
        values.At(x, y) = static_cast<float>(MeanOverPixel(board, T_board_camera, x, y, shade));
    }
  }
  Blur(GaussianWeights(options_.blur_px), values, scratch);
  return values;
}

Image<std::uint16_t> TargetCamera::Thermal(const PerforatedBoard& board,
                                           const RigidTransform& T_camera_board,
                                           std::uint64_t noise_stream) const {
  const double face = band_.RadianceFromCelsius(board.face_celsius);
  const double background = band_.RadianceFromCelsius(board.background_celsius);
  const Image<float> radiance = Render(board, T_camera_board, [&](const BoardHit& hit) {
    if (hit.surface == BoardSurface::kBackground) return background;
    if (hit.surface != BoardSurface::kPlate) return face;
    return band_.RadianceFromCelsius(board.PlateCelsius(hit.p_board.head<2>()));
  });
  Image<std::uint16_t> counts(camera_.width, camera_.height);
  for (std::size_t i = 0; i < counts.size(); ++i) {
    const double celsius = band_.CelsiusFromRadiance(static_cast<double>(radiance.pixels()[i])) +
                           options_.netd_k * static_cast<double>(NormalNoise(noise_stream, i));
    counts.pixels()[i] = RadiometricScale{}.CountOf(celsius);
  }
  return counts;
}

Image<std::uint8_t> TargetCamera::Infrared(const PerforatedBoard& board,
                                           const RigidTransform& T_camera_board,
                                           std::uint64_t noise_stream) const {
  constexpr double kFace = 130.0, kWall = 90.0, kPlate = 18.0, kBackground = 45.0;
  constexpr double kLit_m = 0.7;  // At this distance the face has kFace.
  const RigidTransform T_board_camera = T_camera_board.inverse();
  const Image<float> brightness = Render(board, T_camera_board, [&](const BoardHit& hit) {
    if (hit.surface == BoardSurface::kBackground) return kBackground;
    if (hit.surface == BoardSurface::kPlate) return kPlate;
    const double distance_m = (hit.p_board - T_board_camera.translation()).norm();
    const double lit = kLit_m / distance_m;
    return (hit.surface == BoardSurface::kFace ? kFace : kWall) * lit * lit;
  });
  Image<std::uint8_t> grey(camera_.width, camera_.height);
  for (std::size_t i = 0; i < grey.size(); ++i) {
    const double value =
        static_cast<double>(brightness.pixels()[i]) +
        options_.infrared_noise * static_cast<double>(NormalNoise(noise_stream, i));
    grey.pixels()[i] = static_cast<std::uint8_t>(std::clamp(std::round(value), 0.0, 255.0));
  }
  return grey;
}

Image<std::uint16_t> TargetCamera::Depth(const PerforatedBoard& board,
                                         const RigidTransform& T_camera_board,
                                         std::uint64_t noise_stream) const {
  constexpr double kStep_px = 0.125, kMillimetres = 1e3;
  constexpr double kWander_px = 0.7;  // Which surface a block of pixels at an edge agrees on.
  const double disparity_metres_px = camera_.fx * options_.baseline_m;
  const RigidTransform T_board_camera = T_camera_board.inverse();
  const Image<float> noise = SharedNoise(camera_.width, camera_.height, noise_stream);
  const Image<float> right = SharedNoise(camera_.width, camera_.height, MixBits(noise_stream ^ 1U));
  const Image<float> down = SharedNoise(camera_.width, camera_.height, MixBits(noise_stream ^ 2U));
  Image<std::uint16_t> depth(camera_.width, camera_.height, kNoDepth);
  for (int y = 0; y < camera_.height; ++y) {
    double leftmost = camera_.width;
    for (int x = camera_.width - 1; x >= 0; --x) {
      const double u = 0.5 + kWander_px * static_cast<double>(right.At(x, y));
      const double v = 0.5 + kWander_px * static_cast<double>(down.At(x, y));
      const BoardHit hit = HitAt(board, T_board_camera, x, y, u, v);
      if (hit.surface == BoardSurface::kBackground) continue;
      const double true_px = disparity_metres_px / (T_camera_board * hit.p_board).z();
      // The projector sees a point one disparity further left; what comes out of order from right
      // to left is in a shadow.
      constexpr double kSameSurface_px = 0.5;
      const bool lit = x - true_px <= leftmost + kSameSurface_px;
      leftmost = std::min(leftmost, x - true_px);
      if (!lit) continue;
      const double measured_px =
          true_px + options_.disparity_noise_px * static_cast<double>(noise.At(x, y));
      depth.At(x, y) = static_cast<std::uint16_t>(std::lround(
          kMillimetres * disparity_metres_px / (std::round(measured_px / kStep_px) * kStep_px)));
    }
  }
  return depth;
}

}  // namespace isotherm
