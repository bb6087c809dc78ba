#include "ground/camera_calibration/still_poses.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace isotherm {
namespace {

float Quantile(std::vector<float>& values, double q) {
  const auto at =
      values.begin() + static_cast<std::ptrdiff_t>(q * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

/// Standard deviation of the noise of single pixels: by the median of how far each is off the
/// middle of its neighbours in the row, where images are smooth.
double NoiseOf(const Image<float>& image) {
  std::vector<float> bends;
  for (int y = 0; y < image.height(); ++y) {
    for (int x = 1; x + 1 < image.width(); ++x) {
      const float bend = image.At(x - 1, y) - 2.0F * image.At(x, y) + image.At(x + 1, y);
      if (std::isfinite(bend)) bends.push_back(std::abs(bend));
    }
  }
  if (bends.empty()) return 0.0;
  constexpr double kSigmaPerMedian = 1.4826 / 2.449;  // 1 + 4 + 1 variances.
  return kSigmaPerMedian * static_cast<double>(Quantile(bends, 0.5));
}

}  // namespace

bool LookAlike(const Image<float>& a, const Image<float>& b) {
  if (a.width() != b.width() || a.height() != b.height()) return false;
  std::vector<float> differences;
  for (std::size_t i = 0; i < a.size(); ++i) {
    const float difference = a.pixels()[i] - b.pixels()[i];
    if (std::isfinite(difference)) differences.push_back(difference);
  }
  if (differences.size() < a.size() / 4) return false;
  const float offset = Quantile(differences, 0.5);
  for (float& difference : differences) difference = std::abs(difference - offset);
  // Of noise alone, 3.1 standard deviations are reached by two pixels in a thousand. The holes'
  // rims are some percent of the pixels, and a tenth of a pixel is many times the noise there.
  constexpr double kMaxSigmas = 4.5;
  const double sigma = std::hypot(NoiseOf(a), NoiseOf(b));
  const double tail = static_cast<double>(Quantile(differences, 0.998));
  // Images of whole numbers may be the same but for a few pixels.
  return tail <= std::max(kMaxSigmas * sigma, 2.0);
}

double MovedFraction(const Image<float>& a, const Image<float>& b) {
  if (a.width() != b.width() || a.height() != b.height() || a.empty()) return 1.0;
  // Five standard deviations of the noise of two images of a PrimeSense-like camera, which grows
  // with the square of the depth; at 0.9 m less than from the thesis's board to the plate behind
  // it, and less than from a wall to a board anywhere.
  constexpr float kPerSquare = 1e-5F;  // 1 / mm: 10 mm at 1 m.
  constexpr float kMinTolerance_mm = 4.0F;
  const auto is_like = [&](int x, int y) {
    const float depth = a.At(x, y);
    const float tolerance = std::max(kMinTolerance_mm, kPerSquare * depth * depth);
    for (int v = std::max(0, y - 1); v <= std::min(b.height() - 1, y + 1); ++v) {
      for (int u = std::max(0, x - 1); u <= std::min(b.width() - 1, x + 1); ++u) {
        const float other = b.At(u, v);
        if (std::isnan(other) || std::abs(depth - other) <= tolerance) return true;
      }
    }
    return false;
  };
  std::size_t moved = 0;
  for (int y = 0; y < a.height(); ++y)
    for (int x = 0; x < a.width(); ++x)
      if (!std::isnan(a.At(x, y)) && !is_like(x, y)) ++moved;
  return static_cast<double>(moved) / static_cast<double>(a.size());
}

bool StillPoseFinder::IsSame(const Image<float>& image) const {
  if (!options_.is_depth) return LookAlike(last_, image);
  // A board that moved by a pixel and a half, of whose image the holes' rims are a hundredth for
  // each pixel.
  constexpr double kMaxMoved = 0.005;
  return MovedFraction(pose_.samples.front(), image) <= kMaxMoved;
}

std::optional<StillPose> StillPoseFinder::Add(double time_s, const Image<float>& image) {
  std::optional<StillPose> ended;
  if (pose_.frames > 0 && !IsSame(image)) ended = Close();
  Take(time_s, image);
  last_ = image;
  return ended;
}

std::optional<StillPose> StillPoseFinder::Finish() { return Close(); }

void StillPoseFinder::Take(double time_s, const Image<float>& image) {
  if (pose_.frames == 0) {
    pose_.begin_s = time_s;
    sum_ = Image<float>(image.width(), image.height(), 0.0F);
    counts_ = Image<std::uint16_t>(image.width(), image.height(), 0);
  }
  pose_.end_s = time_s;
  if (pose_.frames >= options_.max_frames) return;
  // Eight of max_frames: enough for the scatter of one, cheap enough to measure each.
  constexpr int kEvery = 5;
  // Of depth the first eight: rims need each.
  constexpr int kDepthSamples = 8;
  const bool is_sample =
      options_.is_depth ? pose_.frames < kDepthSamples : pose_.frames % kEvery == 0;
  if (is_sample) pose_.samples.push_back(image);
  ++pose_.frames;
  for (std::size_t i = 0; i < image.size(); ++i) {
    const float value = image.pixels()[i];
    if (!std::isfinite(value)) continue;
    sum_.pixels()[i] += value;
    ++counts_.pixels()[i];
  }
}

std::optional<StillPose> StillPoseFinder::Close() {
  StillPose pose = std::move(pose_);
  pose_ = {};
  if (pose.frames < options_.min_frames) return std::nullopt;
  pose.mean = std::move(sum_);
  for (std::size_t i = 0; i < pose.mean.size(); ++i) {
    const int count = counts_.pixels()[i];
    pose.mean.pixels()[i] = 2 * count > pose.frames
                                ? pose.mean.pixels()[i] / static_cast<float>(count)
                                : std::numeric_limits<float>::quiet_NaN();
  }
  return pose;
}

}  // namespace isotherm
