#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <string_view>

#include "common/time/line_limiter.h"

namespace isotherm {

/// LineLimiter for the messages of a library, whose kinds are not known beforehand: messages are of
/// one kind if they begin alike, up to the first digit, since what follows are addresses, codes and
/// numbers. One line of each kind is admitted at once, then one in LineLimiter::kInterval. A peer
/// that makes up ever new kinds gets no more lines: those beyond kMaxKinds count as one.
/// Thread-compatible.
class TextLimiter {
 public:
  static constexpr std::size_t kMaxKinds = 32;

  /// Returns the line to write, which says how many of its kind were left out before it; nullopt if
  /// it is left out itself.
  std::optional<std::string> Admit(std::string_view text, SteadyTime now);
  /// Lines that were left out since the last one of their kind that was admitted.
  std::uint64_t untold() const;
  /// All lines that were left out.
  std::uint64_t suppressed() const;

 private:
  LineLimiter& LimiterOf(std::string_view text);

  std::map<std::string, LineLimiter, std::less<>> kinds_;
  LineLimiter others_;
};

}  // namespace isotherm
