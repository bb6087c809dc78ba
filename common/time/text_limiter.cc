#include "common/time/text_limiter.h"

#include <algorithm>
#include <numeric>

namespace isotherm {
namespace {

/// Enough for the words of a message. What a peer can put into one comes later or is cut off.
constexpr std::size_t kMaxKindLength = 60;

std::string_view KindOf(std::string_view text) {
  return text.substr(0, std::min(text.find_first_of("0123456789"), kMaxKindLength));
}

}  // namespace

LineLimiter& TextLimiter::LimiterOf(std::string_view text) {
  const std::string_view kind = KindOf(text);
  if (const auto known = kinds_.find(kind); known != kinds_.end()) return known->second;
  if (kinds_.size() >= kMaxKinds) return others_;
  return kinds_.try_emplace(std::string(kind)).first->second;
}

std::optional<std::string> TextLimiter::Admit(std::string_view text, SteadyTime now) {
  const std::optional<std::uint64_t> left_out = LimiterOf(text).Admit(now);
  if (!left_out) return std::nullopt;
  return std::string(text) + LeftOutText(*left_out);
}

std::uint64_t TextLimiter::untold() const {
  return std::accumulate(
      kinds_.begin(), kinds_.end(), others_.left_out(),
      [](std::uint64_t sum, const auto& kind) { return sum + kind.second.left_out(); });
}

std::uint64_t TextLimiter::suppressed() const {
  return std::accumulate(
      kinds_.begin(), kinds_.end(), others_.suppressed(),
      [](std::uint64_t sum, const auto& kind) { return sum + kind.second.suppressed(); });
}

}  // namespace isotherm
