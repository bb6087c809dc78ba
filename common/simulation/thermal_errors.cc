#include "common/simulation/thermal_errors.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "common/base/noise.h"

namespace isotherm {
namespace {

constexpr double kInfluenceSigmas = 3.0;

std::uint16_t CountOrNone(double value) {
  const double rounded = std::floor(value + 0.5);
  const bool fits = rounded >= 1.0 && rounded <= RadiometricScale::kMaxCount;
  return fits ? static_cast<std::uint16_t>(rounded) : std::uint16_t{0};
}

/// Weighted sums along rows, written so that a second call sums along columns.
Image<float> SumAlongRowsAndTranspose(const Image<float>& in, const std::vector<float>& weights) {
  const int radius = static_cast<int>(weights.size()) - 1;
  Image<float> out(in.height(), in.width());
  for (int y = 0; y < in.height(); ++y) {
    for (int x = 0; x < in.width(); ++x) {
      float sum = 0.0F;
      for (int i = std::max(0, x - radius); i <= std::min(in.width() - 1, x + radius); ++i)
        sum += weights[static_cast<std::size_t>(std::abs(i - x))] * in.At(i, y);
      out.At(y, x) = sum;
    }
  }
  return out;
}

Image<float> GaussianSum(const Image<float>& in, double sigma_px) {
  std::vector<float> weights;
  for (int i = 0; i <= static_cast<int>(std::ceil(kInfluenceSigmas * sigma_px)); ++i)
    weights.push_back(static_cast<float>(std::exp(-0.5 * i * i / (sigma_px * sigma_px))));
  return SumAlongRowsAndTranspose(SumAlongRowsAndTranspose(in, weights), weights);
}

}  // namespace

void AddKelvin(double kelvin, const RadiometricScale& scale, Image<std::uint16_t>& counts) {
  if (kelvin == 0.0) return;
  const double add = kelvin / scale.kelvin_per_count;
  for (std::uint16_t& count : counts.pixels()) {
    if (count != 0) count = CountOrNone(count + add);
  }
}

void AddSceneInfluence(const SceneInfluence& influence, Image<float>& celsius) {
  Image<float> values(celsius.width(), celsius.height());
  Image<float> present(celsius.width(), celsius.height());
  double total = 0.0, pixels = 0.0;
  for (std::size_t i = 0; i < celsius.size(); ++i) {
    if (std::isnan(celsius.pixels()[i])) continue;
    values.pixels()[i] = celsius.pixels()[i];
    present.pixels()[i] = 1.0F;
    total += static_cast<double>(celsius.pixels()[i]);
    pixels += 1.0;
  }
  if (pixels == 0.0) return;
  total /= pixels;
  const Image<float> sums = GaussianSum(values, influence.near_sigma_px);
  const Image<float> divisors = GaussianSum(present, influence.near_sigma_px);
  for (std::size_t i = 0; i < celsius.size(); ++i) {
    const auto own = static_cast<double>(celsius.pixels()[i]);  // NaN stays so.
    const double near = static_cast<double>(sums.pixels()[i] / divisors.pixels()[i]);
    celsius.pixels()[i] = static_cast<float>(own + influence.near_fraction * (near - own) +
                                             influence.total_fraction * (total - own));
  }
}

void AddPattern(double sigma_kelvin, std::uint64_t stream, const RadiometricScale& scale,
                Image<std::uint16_t>& counts) {
  if (sigma_kelvin == 0.0) return;
  const double sigma = sigma_kelvin / scale.kelvin_per_count;
  for (std::size_t i = 0; i < counts.size(); ++i) {
    std::uint16_t& count = counts.pixels()[i];
    if (count != 0)
      count = CountOrNone(count + sigma * static_cast<double>(NormalNoise(stream, i)));
  }
}

double FlickerKelvin(double sigma_kelvin, double memory_s, double time_s, std::uint64_t stream) {
  if (sigma_kelvin == 0.0) return 0.0;
  // Between independent values, so that the variance stays the same on the way.
  const double position = std::max(0.0, time_s / memory_s);
  const double before = std::floor(position);
  const double turn = 0.5 * std::numbers::pi * (position - before);
  const auto counter = static_cast<std::uint64_t>(before);
  return sigma_kelvin * (std::cos(turn) * static_cast<double>(NormalNoise(stream, counter)) +
                         std::sin(turn) * static_cast<double>(NormalNoise(stream, counter + 1)));
}

}  // namespace isotherm
