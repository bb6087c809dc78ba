#include "edge/openni/tick_unwrapper.h"

namespace isotherm {
namespace {

constexpr std::uint64_t kWrap_us = std::uint64_t{1} << 32;

}  // namespace

DeviceTicks TickUnwrapper::Unwrap(std::uint64_t stamp_us) {
  if (last_us_ && stamp_us < *last_us_) {
    if (*last_us_<kWrap_us&& * last_us_ - stamp_us> kWrap_us / 2) {
      ++wraps_;
      epoch_us_ += kWrap_us;
    } else {
      ++resets_;
      epoch_us_ = 0;
    }
  }
  last_us_ = stamp_us;
  return DeviceTicks(std::chrono::microseconds(epoch_us_ + stamp_us));
}

}  // namespace isotherm
