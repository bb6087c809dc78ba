#pragma once

#include <cstdint>
#include <optional>

#include "common/time/time_types.h"

namespace isotherm {

/// Makes one rising time line of a camera's microsecond stamps. OpenNI2 counts in 64 bits, but some
/// drivers pass on what a 32-bit counter says, which starts again every 71.6 minutes.
///
///   backwards by more than half of 32 bits, from below 2^32   the counter wrapped: it goes on
///   any other step backwards                                  a reset: the ticks go backwards
///
/// Pure. Thread-compatible.
class TickUnwrapper {
 public:
  DeviceTicks Unwrap(std::uint64_t stamp_us);

  std::uint64_t wraps() const { return wraps_; }
  std::uint64_t resets() const { return resets_; }

 private:
  std::optional<std::uint64_t> last_us_;
  std::uint64_t wraps_ = 0;
  std::uint64_t epoch_us_ = 0;  ///< Added to stamps: 2^32 per wrap since the last reset.
  std::uint64_t resets_ = 0;
};

}  // namespace isotherm
