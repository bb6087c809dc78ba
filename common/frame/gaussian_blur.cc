#include "common/frame/gaussian_blur.h"

#include <algorithm>
#include <cmath>

namespace isotherm {
namespace {

void BlurRow(std::span<const float> weights, std::span<const float> in, std::span<float> out) {
  const int width = static_cast<int>(in.size());
  const int radius = static_cast<int>(weights.size()) - 1;
  for (int x = 0; x < width; ++x) {
    float sum = weights[0] * in[static_cast<std::size_t>(x)];
    for (int i = 1; i <= radius; ++i) {
      sum += weights[static_cast<std::size_t>(i)] *
             (in[static_cast<std::size_t>(std::max(0, x - i))] +
              in[static_cast<std::size_t>(std::min(width - 1, x + i))]);
    }
    out[static_cast<std::size_t>(x)] = sum;
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
  if (radius == 0) return;
  const int width = image.width(), height = image.height();
  scratch.Resize(width, height);
  for (int y = 0; y < height; ++y) BlurRow(weights, image.Row(y), scratch.Row(y));
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
