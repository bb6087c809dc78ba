#include "common/frame/gaussian_blur.h"

#include <algorithm>
#include <cmath>

namespace isotherm {
namespace {

/// The first and the last pixel go on beyond the border: `padded` has room for them.
void BlurRow(std::span<const float> weights, std::span<const float> in, std::span<float> padded,
             std::span<float> out) {
  const std::size_t radius = weights.size() - 1, width = in.size();
  std::ranges::fill(padded.first(radius), in.front());
  std::ranges::copy(in, padded.begin() + static_cast<std::ptrdiff_t>(radius));
  std::ranges::fill(padded.last(radius), in.back());
  const float* const middle = padded.data() + radius;
  for (std::size_t x = 0; x < width; ++x) out[x] = weights[0] * middle[x];
  for (std::size_t i = 1; i <= radius; ++i) {
    const float weight = weights[i];
    const float* const before = middle - i;
    const float* const after = middle + i;
    for (std::size_t x = 0; x < width; ++x) out[x] += weight * (before[x] + after[x]);
  }
}

}  // namespace

std::vector<float> GaussianWeights(double sigma_px) {
  constexpr double kNegligible = 1e-4;  // Of the whole, on one side.
  const double variance = sigma_px * sigma_px;
  std::vector<double> weights;
  double sum = 0.0;
  for (int i = 0; sum < 1.0 - 2.0 * kNegligible; ++i) {
    weights.push_back(std::exp(-variance) * std::cyl_bessel_i(i, variance));
    sum += weights.back() * (i == 0 ? 1.0 : 2.0);
  }
  std::vector<float> normalized;
  for (const double weight : weights) normalized.push_back(static_cast<float>(weight / sum));
  return normalized;
}

void Blur(std::span<const float> weights, Image<float>& image, Image<float>& scratch) {
  const int radius = static_cast<int>(weights.size()) - 1;
  if (radius == 0 || image.size() == 0) return;
  const int width = image.width(), height = image.height();
  scratch.Resize(width, height);
  std::vector<float> padded(static_cast<std::size_t>(width + 2 * radius));
  for (int y = 0; y < height; ++y) BlurRow(weights, image.Row(y), padded, scratch.Row(y));
  for (int y = 0; y < height; ++y) {
    float* const out = image.Row(y).data();
    const float* const middle = scratch.Row(y).data();
    for (int x = 0; x < width; ++x) out[x] = weights[0] * middle[x];
    for (int i = 1; i <= radius; ++i) {
      const float weight = weights[static_cast<std::size_t>(i)];
      const float* const above = scratch.Row(std::max(0, y - i)).data();
      const float* const below = scratch.Row(std::min(height - 1, y + i)).data();
      for (int x = 0; x < width; ++x) out[x] += weight * (above[x] + below[x]);
    }
  }
}

}  // namespace isotherm
