#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "common/time/time_types.h"

namespace isotherm {

/// Says which frames others wait for.
enum class PiecePriority : std::uint8_t { kLive, kBackfill };

/// Says when the next pieces may leave: evenly at a rate, and those of the recording only while no
/// live frame is under way. Pure: time enters through arguments. Thread-compatible.
class PieceTurn {
 public:
  /// A thread that sleeps may wake so much later: it is made up for.
  static constexpr Nanoseconds kOversleeps = std::chrono::milliseconds(1);

  /// Returns for how long so many bytes have to wait; 0: they leave now.
  Nanoseconds Take(std::size_t bytes, double rate_bit_s, PiecePriority priority, SteadyTime now) {
    constexpr double kBitsPerByte = 8.0;
    if (priority == PiecePriority::kBackfill && is_live_under_way_) return kLook;
    if (turn_ > now) return turn_ - now;
    turn_ = std::max(turn_, now - kOversleeps) +
            FromSeconds(kBitsPerByte * static_cast<double>(bytes) / rate_bit_s);
    return Nanoseconds(0);
  }
  void NoteLive(bool is_under_way) { is_live_under_way_ = is_under_way; }

 private:
  /// A live frame takes some milliseconds at least.
  static constexpr Nanoseconds kLook = std::chrono::milliseconds(5);

  SteadyTime turn_{};
  bool is_live_under_way_ = false;
};

}  // namespace isotherm
