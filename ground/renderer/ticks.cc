#include "ground/renderer/ticks.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "common/base/check.h"

namespace isotherm {
namespace {

// Lets a limit such as 0.3 count as a multiple of 0.1.
constexpr double kSlack = 1e-9;

struct Multiples {
  long first, last;
};

Multiples Within(double min, double max, double step) {
  return {static_cast<long>(std::ceil(min / step - kSlack)),
          static_cast<long>(std::floor(max / step + kSlack))};
}

}  // namespace

std::vector<Tick> RoundTicks(double min, double max, int max_count) {
  CHECK(min < max && max_count >= 2);
  int decade = static_cast<int>(std::floor(std::log10((max - min) / max_count)));
  for (;; ++decade) {
    for (const double mantissa : {1.0, 2.0, 5.0}) {
      const double step = mantissa * std::pow(10.0, decade);
      const Multiples range = Within(min, max, step);
      if (range.last - range.first + 1 > max_count) continue;
      std::vector<Tick> ticks;
      for (long i = range.first; i <= range.last; ++i) {
        const double value = static_cast<double>(i) * step;
        ticks.push_back({value, fmt::format("{:.{}f}", value, std::max(0, -decade))});
      }
      return ticks;
    }
  }
}

}  // namespace isotherm
