#include "ground/experiment/histogram_rendering.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace isotherm {
namespace {

constexpr int kBins = 40, kBar_px = 5, kGap_px = 20, kHeight_px = 150, kInRow = 3;
constexpr Rgb8 kPaper = {255, 255, 255}, kInk = {60, 100, 160}, kAxis = {120, 120, 120};

std::vector<int> Count(const Eigen::VectorXd& values) {
  const double low = values.minCoeff();
  const double step = (values.maxCoeff() - low) / kBins;
  std::vector<int> counts(kBins, 0);
  for (const double value : values) {
    const int bin = step > 0.0 ? static_cast<int>((value - low) / step) : 0;
    ++counts[static_cast<std::size_t>(std::clamp(bin, 0, kBins - 1))];
  }
  return counts;
}

void Draw(const std::vector<int>& counts, int left, int top, RgbImage& image) {
  const int highest = std::max(1, *std::max_element(counts.begin(), counts.end()));
  for (int bin = 0; bin < kBins; ++bin) {
    const int bar = counts[static_cast<std::size_t>(bin)] * kHeight_px / highest;
    for (int x = 0; x < kBar_px; ++x) {
      const int column = left + bin * kBar_px + x;
      image.At(column, top + kHeight_px) = kAxis;
      if (x + 1 == kBar_px) continue;  // A line between bars.
      for (int y = 0; y < bar; ++y) image.At(column, top + kHeight_px - 1 - y) = kInk;
    }
  }
}

}  // namespace

RgbImage HistogramRendering(const Eigen::MatrixXd& samples) {
  const int columns = static_cast<int>(samples.cols());
  const int rows = (columns + kInRow - 1) / kInRow;
  const int cell_x = kBins * kBar_px + kGap_px, cell_y = kHeight_px + kGap_px;
  RgbImage image(kInRow * cell_x + kGap_px, rows * cell_y + kGap_px, kPaper);
  for (int i = 0; i < columns; ++i)
    Draw(Count(samples.col(i)), kGap_px + i % kInRow * cell_x, kGap_px + i / kInRow * cell_y,
         image);
  return image;
}

}  // namespace isotherm
