#pragma once

#include <array>
#include <bit>
#include <cstdint>

/// A difference between a pixel and its prediction (modulo 2^16) as a token, which is entropy
/// coded, and raw bits, which are not: small differences have a token each; of larger ones the
/// token says the magnitude with its two bits below the leading one, as the rest is noise.
namespace isotherm::codec {

inline constexpr std::uint32_t kDirectTokens = 16;
inline constexpr std::uint32_t kResidualTokens = kDirectTokens + 12 * 4;

/// 0, -1, 1, -2, 2, ... -> 0, 1, 2, 3, 4, ...
constexpr std::uint32_t ZigZag(std::uint16_t residual) {
  const std::uint32_t value = residual;
  return (value << 1 ^ (value & 0x8000U ? 0x1FFFFU : 0U)) & 0xFFFFU;
}
constexpr std::uint16_t UnZigZag(std::uint32_t value) {
  return static_cast<std::uint16_t>(value >> 1 ^ (0U - (value & 1U)));
}

constexpr std::uint8_t TokenOf(std::uint32_t value) {
  if (value < kDirectTokens) return static_cast<std::uint8_t>(value);
  const auto magnitude = static_cast<std::uint32_t>(std::bit_width(value)) - 1U;
  return static_cast<std::uint8_t>(kDirectTokens + (magnitude - 4) * 4 +
                                   (value >> (magnitude - 2) & 3U));
}

struct TokenRange {
  std::uint16_t base = 0;  ///< Least value of the token.
  std::uint16_t bits = 0;  ///< Raw bits that follow.
};

constexpr std::array<TokenRange, kResidualTokens> MakeTokenRanges() {
  std::array<TokenRange, kResidualTokens> ranges{};
  for (std::uint32_t token = 0; token < kResidualTokens; ++token) {
    if (token < kDirectTokens) {
      ranges[token] = {.base = static_cast<std::uint16_t>(token), .bits = 0};
      continue;
    }
    const std::uint32_t magnitude = (token - kDirectTokens) / 4 + 4;
    const std::uint32_t leading = 4 + (token - kDirectTokens) % 4;
    ranges[token] = {.base = static_cast<std::uint16_t>(leading << (magnitude - 2)),
                     .bits = static_cast<std::uint16_t>(magnitude - 2)};
  }
  return ranges;
}
inline constexpr std::array<TokenRange, kResidualTokens> kTokenRanges = MakeTokenRanges();

/// Most differences are small: their tokens come from a table.
inline constexpr std::uint32_t kTabulatedValues = 1024;
constexpr std::array<std::uint8_t, kTabulatedValues> MakeTokenTable() {
  std::array<std::uint8_t, kTabulatedValues> tokens{};
  for (std::uint32_t value = 0; value < kTabulatedValues; ++value) tokens[value] = TokenOf(value);
  return tokens;
}
inline constexpr std::array<std::uint8_t, kTabulatedValues> kTokenTable = MakeTokenTable();

}  // namespace isotherm::codec
