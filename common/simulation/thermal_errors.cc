#include "common/simulation/thermal_errors.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "common/base/noise.h"

namespace isotherm {
namespace {

/// Where the Gaussian ends: 0.3 % of it lie beyond, along each axis.
constexpr double kInfluenceSigmas = 3.0;

std::uint16_t CountOrNone(double value) {
  const double rounded = std::floor(value + 0.5);
  const bool fits = rounded >= 1.0 && rounded <= RadiometricScale::kMaxCount;
  return fits ? static_cast<std::uint16_t>(rounded) : std::uint16_t{0};
}

/// Edge of the squares whose means stand for their pixels: surroundings change slowly.
constexpr int kCell_px = 4;

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

/// Smooths an image of cells by a Gaussian of `sigma_px` pixels of the full image.
Image<float> GaussianSum(const Image<float>& cells, double sigma_px) {
  // Means over cells, and interpolation between them, spread what is in them already.
  constexpr double kCellVariance_px2 = (kCell_px * kCell_px - 1.0) / 12.0;
  constexpr double kInterpolationVariance_px2 = kCell_px * kCell_px / 6.0;
  const double sigma =
      std::sqrt(sigma_px * sigma_px - kCellVariance_px2 - kInterpolationVariance_px2) / kCell_px;
  std::vector<float> weights;
  for (int i = 0; i <= static_cast<int>(std::ceil(kInfluenceSigmas * sigma)); ++i)
    weights.push_back(static_cast<float>(std::exp(-0.5 * i * i / (sigma * sigma))));
  return SumAlongRowsAndTranspose(SumAlongRowsAndTranspose(cells, weights), weights);
}

int Cells(int pixels) { return (pixels + kCell_px - 1) / kCell_px; }

/// Says which two cells a pixel lies between, and how far towards the second.
struct BetweenCells {
  int first, second;
  float fraction;

  static BetweenCells Of(int pixel, int cells) {
    const float position = (static_cast<float>(pixel) + 0.5F) / kCell_px - 0.5F;
    const float inside = std::clamp(position, 0.0F, static_cast<float>(cells - 1));
    const int first = static_cast<int>(inside);
    return {first, std::min(first + 1, cells - 1), inside - static_cast<float>(first)};
  }
};

float Interpolate(const Image<float>& cells, const BetweenCells& x, const BetweenCells& y) {
  const float above =
      std::lerp(cells.At(x.first, y.first), cells.At(x.second, y.first), x.fraction);
  const float below =
      std::lerp(cells.At(x.first, y.second), cells.At(x.second, y.second), x.fraction);
  return std::lerp(above, below, y.fraction);
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
  const int width = celsius.width(), height = celsius.height();
  Image<float> values(Cells(width), Cells(height)), present(Cells(width), Cells(height));
  double total = 0.0, pixels = 0.0;
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const float own = celsius.At(x, y);
      if (std::isnan(own)) continue;
      values.At(x / kCell_px, y / kCell_px) += own;
      present.At(x / kCell_px, y / kCell_px) += 1.0F;
      total += static_cast<double>(own);
      pixels += 1.0;
    }
  }
  if (pixels == 0.0) return;
  total /= pixels;
  const Image<float> sums = GaussianSum(values, influence.near_sigma_px);
  const Image<float> divisors = GaussianSum(present, influence.near_sigma_px);
  std::vector<BetweenCells> columns;
  for (int x = 0; x < width; ++x) columns.push_back(BetweenCells::Of(x, values.width()));
  for (int y = 0; y < height; ++y) {
    const BetweenCells row = BetweenCells::Of(y, values.height());
    for (int x = 0; x < width; ++x) {
      const BetweenCells& column = columns[static_cast<std::size_t>(x)];
      const auto own = static_cast<double>(celsius.At(x, y));  // NaN stays so.
      const double near =
          static_cast<double>(Interpolate(sums, column, row) / Interpolate(divisors, column, row));
      celsius.At(x, y) = static_cast<float>(own + influence.near_fraction * (near - own) +
                                            influence.total_fraction * (total - own));
    }
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
  const double angle_rad = 0.5 * std::numbers::pi * (position - before);
  const auto counter = static_cast<std::uint64_t>(before);
  return sigma_kelvin *
         (std::cos(angle_rad) * static_cast<double>(NormalNoise(stream, counter)) +
          std::sin(angle_rad) * static_cast<double>(NormalNoise(stream, counter + 1)));
}

}  // namespace isotherm
