#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>

#include "common/time/time_types.h"

namespace isotherm {

/// For messages that may come with every frame: some are admitted in each interval, the others are
/// counted, and the next one that is admitted says how many. Thread-compatible.
class LineLimiter {
 public:
  /// Lines that a per-frame message may write: one at once, then one in this much time.
  static constexpr Nanoseconds kInterval = std::chrono::seconds(10);

  LineLimiter() : LineLimiter(1, kInterval) {}
  LineLimiter(int max_lines, Nanoseconds interval) : max_lines_(max_lines), interval_(interval) {}

  /// Decides whether this line may be written: returns how many were left out since the last one,
  /// or nullopt if it is left out too.
  std::optional<std::uint64_t> Admit(SteadyTime now) {
    if (!window_start_ || now - *window_start_ >= interval_) {
      window_start_ = now;
      in_window_ = 0;
    }
    if (in_window_ < max_lines_) {
      ++in_window_;
      return std::exchange(left_out_, 0);
    }
    ++left_out_;
    ++suppressed_;
    return std::nullopt;
  }
  /// Lines that were left out since the last admitted one, which nobody has been told of.
  std::uint64_t left_out() const { return left_out_; }
  /// All lines that were left out.
  std::uint64_t suppressed() const { return suppressed_; }

 private:
  const int max_lines_;
  const Nanoseconds interval_;
  std::optional<SteadyTime> window_start_;
  int in_window_ = 0;
  std::uint64_t left_out_ = 0;
  std::uint64_t suppressed_ = 0;
};

/// " (99 more since the last such line)" for the end of an admitted line; empty if none was left
/// out.
inline std::string LeftOutText(std::uint64_t left_out) {
  if (left_out == 0) return "";
  return " (" + std::to_string(left_out) + " more since the last such line)";
}

}  // namespace isotherm
