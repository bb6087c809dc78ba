#include "common/simulation/depth_defects.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "common/base/noise.h"
#include "common/frame/frame.h"

namespace isotherm {
namespace {

// Together with the grid this leaves 36 % of the pixels, as the coarse grid does, so that both
// spoil images equally much: 1 - (2/3)^2 (1 - 0.19) = 0.64 are empty. Random dropout is like them;
// with much more nothing is left to track.
constexpr double kGridDropout = 0.19;
constexpr double kRandomDropout = 0.6;
constexpr double kFlyingFraction = 0.3;

/// Neighbours whose depth differs by more than this fraction are an edge: 7 mm at half a metre,
/// which a surface reaches only beyond 80 degrees. Smaller: slanted surfaces get flying pixels.
constexpr double kSpoiltEdgeStepRatio = 0.015;

bool IsEmpty(DepthDefect defect, int x, int y, double chance) {
  switch (defect) {
    case DepthDefect::kGrid:
      return x % 3 == 2 || y % 3 == 2 || chance < kGridDropout;
    case DepthDefect::kCoarseGrid:
      return x % 5 >= 3 || y % 5 >= 3;
    case DepthDefect::kRandom:
      return chance < kRandomDropout;
    case DepthDefect::kRows:
      return y % 2 == 0;
    case DepthDefect::kColumns:
      return x % 2 == 0;
    case DepthDefect::kNone:
    case DepthDefect::kFlyingPixels:
      break;
  }
  return false;
}

/// The depth across an edge beside the pixel; its own if there is none.
std::uint16_t AcrossEdge(const Image<std::uint16_t>& depth_raw, int x, int y) {
  const std::uint16_t own = depth_raw.At(x, y);
  for (const auto& [dx, dy] : {std::pair(1, 0), {0, 1}, {-1, 0}, {0, -1}}) {
    if (!depth_raw.Contains(x + dx, y + dy)) continue;
    const std::uint16_t other = depth_raw.At(x + dx, y + dy);
    if (other != kNoDepth && std::abs(other - own) > kSpoiltEdgeStepRatio * own) return other;
  }
  return own;
}

}  // namespace

std::string_view ToString(DepthDefect defect) {
  switch (defect) {
    case DepthDefect::kNone:
      return "none";
    case DepthDefect::kGrid:
      return "grid";
    case DepthDefect::kCoarseGrid:
      return "coarse-grid";
    case DepthDefect::kRandom:
      return "random";
    case DepthDefect::kRows:
      return "rows";
    case DepthDefect::kColumns:
      return "columns";
    case DepthDefect::kFlyingPixels:
      return "flying";
  }
  return "unknown";
}

void AddFlyingPixels(double fraction, std::uint64_t noise_stream, Image<std::uint16_t>& depth_raw) {
  const Image<std::uint16_t> before = depth_raw;
  std::uint64_t counter = 0;
  for (int y = 0; y < before.height(); ++y) {
    for (int x = 0; x < before.width(); ++x, counter += 2) {
      if (before.At(x, y) == kNoDepth || UniformNoise(noise_stream, counter) >= fraction) continue;
      const double across = UniformNoise(noise_stream, counter + 1);
      const double own = before.At(x, y);
      const double other = AcrossEdge(before, x, y);
      depth_raw.At(x, y) = static_cast<std::uint16_t>(std::lround(std::lerp(own, other, across)));
    }
  }
}

void AddDefect(DepthDefect defect, std::uint64_t noise_stream, Image<std::uint16_t>& depth_raw) {
  if (defect == DepthDefect::kNone) return;
  if (defect == DepthDefect::kFlyingPixels)
    return AddFlyingPixels(kFlyingFraction, noise_stream, depth_raw);
  std::uint64_t counter = 0;
  for (int y = 0; y < depth_raw.height(); ++y) {
    for (int x = 0; x < depth_raw.width(); ++x, ++counter) {
      if (IsEmpty(defect, x, y, UniformNoise(noise_stream, counter))) depth_raw.At(x, y) = kNoDepth;
    }
  }
}

}  // namespace isotherm
