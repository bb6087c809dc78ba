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
      divisors_(columns_, rows_),
      covered_(columns_, rows_),
      row_sums_(columns_, rows_),
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

void SceneInfluenceCorrector::SumNeighbourhoods(const Image<float>& cells, Image<float>& sums) {
  const int radius = static_cast<int>(weights_.size()) - 1;
  row_sums_.Fill(0.0F);
  sums.Fill(0.0F);
  // Neighbour by neighbour for a whole row at once, which the compiler makes vectors of.
  for (int offset = -radius; offset <= radius; ++offset) {
    const float weight = weights_[static_cast<std::size_t>(std::abs(offset))];
    const int first = std::max(0, -offset), last = std::min(columns_, columns_ - offset);
    for (int y = 0; y < rows_; ++y) {
      const float* const in = cells.Row(y).data();
      float* const out = row_sums_.Row(y).data();
      for (int x = first; x < last; ++x) out[x] += weight * in[x + offset];
    }
  }
  for (int y = 0; y < rows_; ++y) {
    float* const out = sums.Row(y).data();
    for (int i = std::max(0, y - radius); i <= std::min(rows_ - 1, y + radius); ++i) {
      const float weight = weights_[static_cast<std::size_t>(std::abs(i - y))];
      const float* const in = row_sums_.Row(i).data();
      for (int x = 0; x < columns_; ++x) out[x] += weight * in[x];
    }
  }
}

void SceneInfluenceCorrector::AverageNeighbourhoods() {
  for (std::size_t i = 0; i < values_.size(); ++i)
    covered_.pixels()[i] = coverage_.pixels()[i] * values_.pixels()[i];
  SumNeighbourhoods(covered_, near_);
  for (std::size_t i = 0; i < near_.size(); ++i) {
    // Nothing has a value within reach: nothing is corrected there.
    const float divisor = divisors_.pixels()[i];
    near_.pixels()[i] = divisor > 0.0F ? near_.pixels()[i] / divisor : values_.pixels()[i];
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
  SumNeighbourhoods(coverage_, divisors_);
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
