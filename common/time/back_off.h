#pragma once

#include <algorithm>

#include "common/time/time_types.h"

namespace isotherm {

/// Tells how long to wait before something that failed is tried again: the first wait, doubled each
/// time up to the last. Thread-compatible.
class BackOff {
 public:
  constexpr explicit BackOff(Nanoseconds first = std::chrono::milliseconds(500),
                             Nanoseconds last = std::chrono::seconds(5))
      : first_(first), last_(last), next_(first) {}

  /// The wait from now on.
  constexpr Nanoseconds Next() {
    const Nanoseconds wait = next_;
    next_ = std::min(2 * next_, last_);
    return wait;
  }
  /// It worked: the next failure starts over.
  constexpr void Reset() { next_ = first_; }

 private:
  Nanoseconds first_;
  Nanoseconds last_;
  Nanoseconds next_;
};

}  // namespace isotherm
