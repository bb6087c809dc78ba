#pragma once

#include <string>
#include <vector>

namespace isotherm {

/// A round number on a scale and how it is written.
struct Tick {
  double value = 0.0;
  std::string label;
};

/// Multiples of 1, 2 or 5 times a power of ten within [min, max], ascending, as many as possible
/// but at most `max_count` (>= 2). All labels have the same number of decimals.
std::vector<Tick> RoundTicks(double min, double max, int max_count);

}  // namespace isotherm
