#include "ground/experiment/pixel_response.h"

#include <algorithm>

namespace isotherm {

double PixelResponse(double from_px, double to_px) {
  constexpr double kHalfPixel = 0.5;
  return std::max(0.0, std::min(to_px, kHalfPixel) - std::max(from_px, -kHalfPixel));
}

double SquareResponse(double half_edge_px, double circle_px) {
  // 400 x 400 points: the mean is right to about a thousandth.
  constexpr int kSteps = 400;
  const double radius = 0.5 * circle_px;
  double sum = 0.0;
  int count = 0;
  for (int i = 0; i < kSteps; ++i) {
    for (int j = 0; j < kSteps; ++j) {
      const double x = (2.0 * (i + 0.5) / kSteps - 1.0) * radius;
      const double y = (2.0 * (j + 0.5) / kSteps - 1.0) * radius;
      if (x * x + y * y > radius * radius) continue;
      sum += PixelResponse(-half_edge_px - x, half_edge_px - x) *
             PixelResponse(-half_edge_px - y, half_edge_px - y);
      ++count;
    }
  }
  return sum / count;
}

}  // namespace isotherm
