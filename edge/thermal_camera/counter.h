#pragma once

#include <cstdint>
#include <optional>

namespace isotherm {

/// Continues a counter of a camera beyond its wrap. A value that is behind by less than half the
/// range was reset, not wrapped, and goes backwards. Thread-compatible.
class Unwrapper {
 public:
  /// The counter has `bits` bits (8..32).
  explicit Unwrapper(int bits) : range_(std::uint64_t{1} << bits) {}

  std::uint64_t Process(std::uint32_t value) {
    if (last_ && value<*last_&& * last_ - value> range_ / 2) base_ += range_;
    if (last_ && value < *last_ && *last_ - value <= range_ / 2) base_ = 0;
    last_ = value;
    return base_ + value;
  }
  void Reset() {
    last_.reset();
    base_ = 0;
  }

 private:
  const std::uint64_t range_;
  std::optional<std::uint32_t> last_;
  std::uint64_t base_ = 0;
};

}  // namespace isotherm
