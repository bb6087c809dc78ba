#include "ground/thermal/scene_influence_corrector.h"

#include <algorithm>
#include <cmath>

#include "common/base/check.h"

namespace isotherm {
namespace {

constexpr int kCellPixels = SceneInfluenceCorrector::kCellPixels;
/// The Gaussian ends here, where 0.3 % of it are left along each axis; the weights are divided by
/// their sum.
constexpr double kCutOffSigmas = 3.0;
// Each leaves at most near_fraction / (1 - sum of the fractions) of the error, which is half of it
// at the largest that are allowed, a twentieth for a PI 450; the mean of the image is right from
// the first on.
constexpr int kIterations = 8;

std::vector<float> GaussianWeights(double sigma) {
  std::vector<float> weights{1.0F};
  for (int i = 1; i <= static_cast<int>(std::ceil(kCutOffSigmas * sigma)); ++i)
    weights.push_back(static_cast<float>(std::exp(-0.5 * i * i / (sigma * sigma))));
  return weights;
}

int Cells(int pixels) { return (pixels + kCellPixels - 1) / kCellPixels; }

CellInterpolation CellsAround(double pixel, int cells) {
  const float position =
      (static_cast<float>(pixel) + 0.5F) / static_cast<float>(kCellPixels) - 0.5F;
  const float at = std::clamp(position, 0.0F, static_cast<float>(cells - 1));
  const int first = std::min(static_cast<int>(at), std::max(0, cells - 2));
  return {first, std::min(first + 1, cells - 1), at - static_cast<float>(first)};
}

}  // namespace

float InfluenceMeans::NearAt(double x, double y) const {
  const CellInterpolation columns = CellsAround(x, near.width());
  const CellInterpolation rows = CellsAround(y, near.height());
  const auto along_row = [&](int row) {
    const float first = near.At(columns.first, row), second = near.At(columns.second, row);
    return first + columns.fraction * (second - first);
  };
  const float upper = along_row(rows.first);
  return upper + rows.fraction * (along_row(rows.second) - upper);
}

SceneInfluenceCorrector::SceneInfluenceCorrector(const SceneInfluence& influence, int width,
                                                 int height)
    : influence_(influence),
      columns_(Cells(width)),
      rows_(Cells(height)),
      weights_(GaussianWeights(influence.near_sigma_px / kCellPixels)),
      measured_(columns_, rows_),
      coverage_(columns_, rows_),
      values_(columns_, rows_),
      near_(columns_, rows_),
      sums_(columns_, rows_),
      divisors_(columns_, rows_),
      near_row_(static_cast<std::size_t>(columns_)) {
  CHECK(width > 0 && height > 0);
  for (int x = 0; x < width; ++x) across_.push_back(CellsAround(x, columns_));
}

void SceneInfluenceCorrector::AverageCells(const Image<float>& celsius) {
  measured_.Fill(0.0F);
  coverage_.Fill(0.0F);
  for (int y = 0; y < celsius.height(); ++y) {
    const std::span<const float> row = celsius.Row(y);
    const std::span<float> sums = measured_.Row(y / kCellPixels);
    const std::span<float> counts = coverage_.Row(y / kCellPixels);
    for (std::size_t x = 0; x < row.size(); ++x) {
      if (std::isnan(row[x])) continue;
      sums[x / kCellPixels] += row[x];
      counts[x / kCellPixels] += 1.0F;
    }
  }
  for (std::size_t i = 0; i < measured_.size(); ++i) {
    if (coverage_.pixels()[i] > 0.0F) measured_.pixels()[i] /= coverage_.pixels()[i];
  }
}

void SceneInfluenceCorrector::AverageNeighbourhoods() {
  const int radius = static_cast<int>(weights_.size()) - 1;
  const auto weight = [this](int offset) {
    return weights_[static_cast<std::size_t>(std::abs(offset))];
  };
  for (int y = 0; y < rows_; ++y) {
    for (int x = 0; x < columns_; ++x) {
      float sum = 0.0F, divisor = 0.0F;
      for (int i = std::max(0, x - radius); i <= std::min(columns_ - 1, x + radius); ++i) {
        const float w = weight(i - x) * coverage_.At(i, y);
        sum += w * values_.At(i, y);
        divisor += w;
      }
      sums_.At(x, y) = sum;
      divisors_.At(x, y) = divisor;
    }
  }
  for (int y = 0; y < rows_; ++y) {
    for (int x = 0; x < columns_; ++x) {
      float sum = 0.0F, divisor = 0.0F;
      for (int i = std::max(0, y - radius); i <= std::min(rows_ - 1, y + radius); ++i) {
        sum += weight(i - y) * sums_.At(x, i);
        divisor += weight(i - y) * divisors_.At(x, i);
      }
      // Nothing has a value within reach: nothing is corrected there.
      near_.At(x, y) = divisor > 0.0F ? sum / divisor : values_.At(x, y);
    }
  }
}

float SceneInfluenceCorrector::AverageAll() const {
  double sum = 0.0, divisor = 0.0;
  for (std::size_t i = 0; i < values_.size(); ++i) {
    sum += static_cast<double>(coverage_.pixels()[i]) * static_cast<double>(values_.pixels()[i]);
    divisor += static_cast<double>(coverage_.pixels()[i]);
  }
  return divisor > 0.0 ? static_cast<float>(sum / divisor) : 0.0F;
}

void SceneInfluenceCorrector::Correct(Image<float>& celsius) {
  CHECK(celsius.width() == static_cast<int>(across_.size()) && Cells(celsius.height()) == rows_);
  const auto near_fraction = static_cast<float>(influence_.near_fraction);
  const auto total_fraction = static_cast<float>(influence_.total_fraction);
  const float gain = 1.0F / (1.0F - near_fraction - total_fraction);
  AverageCells(celsius);
  std::ranges::copy(measured_.pixels(), values_.pixels().begin());
  // The means are of the own temperatures, which are what is looked for: begin with the measured
  // ones, and repeat.
  for (int iteration = 0; iteration < kIterations; ++iteration) {
    AverageNeighbourhoods();
    total_ = AverageAll();
    for (std::size_t i = 0; i < values_.size(); ++i) {
      values_.pixels()[i] = gain * (measured_.pixels()[i] - near_fraction * near_.pixels()[i] -
                                    total_fraction * total_);
    }
  }
  Subtract({near_fraction, total_fraction * total_, gain}, celsius);
}

void SceneInfluenceCorrector::Subtract(const CorrectionTerms& terms, Image<float>& celsius) {
  for (int y = 0; y < celsius.height(); ++y) {
    const CellInterpolation rows = CellsAround(y, rows_);
    const std::span<const float> upper = near_.Row(rows.first), lower = near_.Row(rows.second);
    for (std::size_t i = 0; i < near_row_.size(); ++i)
      near_row_[i] = upper[i] + rows.fraction * (lower[i] - upper[i]);
    const std::span<float> row = celsius.Row(y);
    for (std::size_t x = 0; x < row.size(); ++x) {
      const CellInterpolation& columns = across_[x];
      const float first = near_row_[static_cast<std::size_t>(columns.first)];
      const float second = near_row_[static_cast<std::size_t>(columns.second)];
      const float near = first + columns.fraction * (second - first);
      row[x] = terms.gain * (row[x] - terms.near_fraction * near - terms.total);
    }
  }
}

}  // namespace isotherm
