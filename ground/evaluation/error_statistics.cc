#include "ground/evaluation/error_statistics.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace isotherm {

ErrorStatistics Summarize(std::vector<double> magnitudes) {
  ErrorStatistics result;
  result.count = magnitudes.size();
  if (magnitudes.empty()) {
    result.rms = result.median = result.p95 = result.max = std::numeric_limits<double>::quiet_NaN();
    return result;
  }
  std::sort(magnitudes.begin(), magnitudes.end());
  const auto rank = [&](double fraction) {
    const double position = std::ceil(fraction * static_cast<double>(magnitudes.size()));
    return magnitudes[static_cast<std::size_t>(std::max(position, 1.0)) - 1];
  };
  double squares = 0.0;
  for (const double value : magnitudes) squares += value * value;
  result.rms = std::sqrt(squares / static_cast<double>(magnitudes.size()));
  result.median = rank(0.5);
  result.p95 = rank(0.95);
  result.max = magnitudes.back();
  return result;
}

}  // namespace isotherm
