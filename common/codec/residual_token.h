#pragma once

#include <array>
#include <bit>
#include <cstdint>

/// A difference between a pixel and its prediction (modulo 2^16) as a token, which is entropy
/// coded, and raw bits, which are not: small differences have a token each; of larger ones the
/// token says the magnitude with its two bits below the leading one, as the rest is noise.
namespace isotherm::codec {

inline constexpr int kDirectTokens = 16;
inline constexpr int kResidualTokens = kDirectTokens + 12 * 4;

/// Maps 0, -1, 1, -2, 2, ... to 0, 1, 2, 3, 4, ...
constexpr int ZigZag(int residual) {
  const auto value = static_cast<std::int16_t>(residual);
  return static_cast<std::uint16_t>(value << 1 ^ value >> 15);
}
constexpr int UnZigZag(int value) { return value >> 1 ^ -(value & 1); }

/// Holds a residual as the entropy coder takes it: its magnitude class, and the bits below it that
/// are stored as they are.
struct Token {
  int token = 0;
  int raw_bits = 0;  ///< How many of the lowest bits follow.
};

/// Returns the token of a value: the exponent and the two leading bits of the mantissa of a float
/// are just what a token is made of.
constexpr Token TokenOf(int value) {
  constexpr int kMantissaBits = 23;
  constexpr int kBias = 127;
  const int bits = std::bit_cast<int>(static_cast<float>(value));
  const bool direct = value < kDirectTokens;
  return {.token = direct ? value : (bits >> (kMantissaBits - 2)) - 4 * kBias,
          .raw_bits = direct ? 0 : (bits >> kMantissaBits) - kBias - 2};
}

/// The values of a token: `base` and what `raw_bits` add.
struct TokenRange {
  std::uint16_t base = 0;
  std::uint16_t raw_bits = 0;
};

/// Returns the inverse of TokenOf: token 4 e + m stands for the values from (4 + m) 2^(e-2), e >=
/// 4.
constexpr std::array<TokenRange, kResidualTokens> MakeTokenRanges() {
  std::array<TokenRange, kResidualTokens> ranges{};
  for (int token = 0; token < kResidualTokens; ++token) {
    const bool direct = token < kDirectTokens;
    const int raw_bits = direct ? 0 : token / 4 - 2;
    const int base = direct ? token : (4 + token % 4) << raw_bits;
    ranges[static_cast<std::size_t>(token)] = {.base = static_cast<std::uint16_t>(base),
                                               .raw_bits = static_cast<std::uint16_t>(raw_bits)};
  }
  return ranges;
}
inline constexpr std::array<TokenRange, kResidualTokens> kTokenRanges = MakeTokenRanges();
/// Returns whether the first and the last value of each range have its token.
constexpr bool RangesAreThoseOfTokens() {
  for (int token = 0; token < kResidualTokens; ++token) {
    const TokenRange range = kTokenRanges[static_cast<std::size_t>(token)];
    for (const int value : {int{range.base}, range.base + (1 << range.raw_bits) - 1}) {
      if (TokenOf(value).token != token || TokenOf(value).raw_bits != range.raw_bits) return false;
    }
  }
  return true;
}
static_assert(RangesAreThoseOfTokens());

/// Returns the number of bits of `value`, which must be below 2^31.
constexpr int BitWidth(int value) {
  return static_cast<int>(std::bit_width(static_cast<unsigned>(value) << 1 | 1U)) - 1;
}
}  // namespace isotherm::codec
