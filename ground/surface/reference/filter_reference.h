#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "common/frame/frame.h"
#include "common/testing/kernel_checks.h"
#include "ground/surface/filter_kernel.h"

// These functions do what the kernels beside this folder must do, one element at a time and in
// double precision: they are their specification. Compiled for tests only.
namespace isotherm::reference {

/// The bilateral filter's mean with the biweight's weights.
inline double FilterPixel(const BilateralRowArgs& a, int x) {
  const double centre = a.rows[a.radius][x];
  if (!(centre > 0.0)) return 0.0;
  const double tau = std::min(a.tau_at_1m * centre, 1.0) * centre;
  double sum = 0.0;
  double weights = 0.0;
  for (int dy = -a.radius; dy <= a.radius; ++dy) {
    const float* row = a.rows[dy + a.radius];
    for (int dx = -a.radius; row != nullptr && dx <= a.radius; ++dx) {
      if (x + dx < 0 || x + dx >= a.width || row[x + dx] == 0.0F) continue;
      const double u = (row[x + dx] - centre) / tau;
      const double falloff = std::pow(std::max(0.0, 1.0 - u * u), 2);
      const double w = falloff * a.spatial[(dy + a.radius) * (2 * a.radius + 1) + dx + a.radius];
      sum += w * row[x + dx];
      weights += w;
    }
  }
  return sum / weights;
}

/// Metres of a raw depth; 0 = none. Products of single precision, as is said of the limits.
inline double Metres(const MetresRowArgs& a, std::uint16_t raw) {
  const float depth = static_cast<float>(raw) * a.metres_per_unit;
  const bool good = raw != kNoDepth && raw != kNoDepthSaturated && depth >= a.min_depth_m &&
                    depth <= a.max_depth_m;
  return good ? double{a.metres_per_unit} * raw : 0.0;
}

/// Mean of those near the nearest; each bound of it, where rounding may decide which are near.
struct HalfPixel {
  std::vector<double> means;
};

inline HalfPixel HalvePixel(const HalfRowArgs& a, int x) {
  std::vector<double> z;
  for (const float* row : {a.upper, a.lower}) {
    for (const int column : {2 * x, 2 * x + 1}) {
      if (row[column] > 0.0F) z.push_back(row[column]);
    }
  }
  if (z.empty()) return {{0.0}};
  std::sort(z.begin(), z.end());
  HalfPixel result;
  for (const double slack : {-testing::kSinglePrecision, testing::kSinglePrecision}) {
    double sum = 0.0;
    double count = 0.0;
    for (const double value : z) {
      if (value != z.front() && value - z.front() > (a.max_step_ratio + slack) * z.front())
        continue;
      sum += value;
      count += 1.0;
    }
    result.means.push_back(sum / count);
  }
  return result;
}

}  // namespace isotherm::reference
