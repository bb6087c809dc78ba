#include "edge/openni/tick_unwrapper.h"

namespace isotherm {
namespace {

constexpr std::uint64_t kTurn_us = std::uint64_t{1} << 32;

}  // namespace

DeviceTicks TickUnwrapper::Unwrap(std::uint64_t stamp_us) {
  if (last_us_ && stamp_us < *last_us_) {
    if (*last_us_<kTurn_us&& * last_us_ - stamp_us> kTurn_us / 2) {
      ++wraps_;
      epoch_us_ += kTurn_us;
    } else {
      ++resets_;
      epoch_us_ = 0;
    }
  }
  last_us_ = stamp_us;
  return DeviceTicks(std::chrono::microseconds(epoch_us_ + stamp_us));
}

}  // namespace isotherm
