#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include "common/base/check.h"

namespace isotherm {

/// The value that a fraction (0..1) of the others lies below, by nearest rank downwards: 0 is the
/// least, 1 the largest. Changes the order of `values`; there must be some, and none NaN.
template <typename T>
T TakeQuantile(std::vector<T>& values, double fraction) {
  CHECK(!values.empty() && fraction >= 0.0 && fraction <= 1.0);
  const auto at = values.begin() +
                  static_cast<std::ptrdiff_t>(fraction * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

/// The middle value; of an even number of values the upper one of the middle two. Changes the order
/// of `values`; there must be some, and none NaN.
template <typename T>
T TakeMedian(std::vector<T>& values) {
  CHECK(!values.empty());
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace isotherm
