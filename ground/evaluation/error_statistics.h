#pragma once

#include <cstddef>
#include <vector>

namespace isotherm {

/// Holds what is said about a set of errors, in their unit. All NaN if there are none.
struct ErrorStatistics {
  std::size_t count = 0;
  double rms = 0.0;
  double median = 0.0;
  double p95 = 0.0;  ///< 95 % are not larger (nearest rank).
  double max = 0.0;
};

/// Statistics of magnitudes (errors without sign).
ErrorStatistics Summarize(std::vector<double> magnitudes);

}  // namespace isotherm
