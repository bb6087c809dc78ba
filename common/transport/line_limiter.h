#pragma once

#include <cstdint>

#include "common/time/time_types.h"

namespace isotherm {

/// Admits at most a number of lines in each second and counts the others. Thread-compatible.
class LineLimiter {
 public:
  explicit LineLimiter(int max_per_second) : max_per_second_(max_per_second) {}

  bool Admit(SteadyTime now) {
    if (now - window_start_ >= std::chrono::seconds(1)) {
      window_start_ = now;
      in_window_ = 0;
    }
    if (in_window_ < max_per_second_) {
      ++in_window_;
      return true;
    }
    ++suppressed_;
    return false;
  }
  std::uint64_t suppressed() const { return suppressed_; }

 private:
  const int max_per_second_;
  SteadyTime window_start_{};
  int in_window_ = 0;
  std::uint64_t suppressed_ = 0;
};

}  // namespace isotherm
