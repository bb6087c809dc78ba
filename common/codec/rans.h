#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "common/codec/byte_io.h"

/// Range asymmetric numeral systems (Duda, "Asymmetric numeral systems", arXiv:1311.2540,
/// section 2.3): an entropy coder as dense as arithmetic coding with a multiplication per symbol.
/// State 32 bits in [2^16, 2^32), written in 16-bit words; frequencies are fixed per payload and
/// add up to 2^10.
namespace isotherm::codec {

inline constexpr unsigned kScaleBits = 10;
inline constexpr std::uint32_t kScale = 1U << kScaleBits;
inline constexpr std::uint32_t kMinState = 1U << 16;

/// Scales `counts` so that they add up to kScale and no symbol that occurs gets 0. All zero stays
/// all zero.
void NormalizeCounts(std::span<const std::uint32_t> counts, std::span<std::uint16_t> frequencies);

void PutFrequencies(std::span<const std::uint16_t> frequencies, std::vector<std::uint8_t>& out);
/// False unless they add up to kScale or are all zero.
bool GetFrequencies(PayloadReader& in, std::span<std::uint16_t> frequencies);

/// Holds what the decoder needs to know about the contexts' symbols: first the symbol of a slot,
/// then its place. Two small tables stay in the first-level cache where one large one would not.
/// Symbols are below kMaxSymbols.
template <std::size_t kContexts>
class DecodeTables {
 public:
  /// Tokens of 16-bit residuals are below it, and a symbol fits a byte.
  static constexpr std::size_t kMaxSymbols = 128;

  /// Says where a symbol's slots begin in the table of its context and how many there are.
  struct Place {
    std::uint16_t frequency = 0;
    std::uint16_t start = 0;
  };

  void Set(std::size_t context, std::span<const std::uint16_t> frequencies) {
    std::uint8_t* slot = symbols_.data() + context * kScale;
    // A context that does not occur must not keep the symbols of the image before.
    std::fill_n(slot, kScale, std::uint8_t{0});
    std::uint32_t start = 0;
    for (std::size_t symbol = 0; symbol < frequencies.size(); ++symbol) {
      places_[context * kMaxSymbols + symbol] = {.frequency = frequencies[symbol],
                                                 .start = static_cast<std::uint16_t>(start)};
      std::fill_n(slot + start, frequencies[symbol], static_cast<std::uint8_t>(symbol));
      start += frequencies[symbol];
    }
  }

  std::uint32_t SymbolOf(std::size_t context, std::uint32_t slot) const {
    return symbols_[context * kScale + slot];
  }
  Place PlaceOf(std::size_t context, std::uint32_t symbol) const {
    return places_[context * kMaxSymbols + symbol];
  }

 private:
  std::array<std::uint8_t, kContexts * kScale> symbols_;
  std::array<Place, kContexts * kMaxSymbols> places_;
};

/// Reads little-endian words. Behind their end it reads zeros and ok() is false. Thread-compatible.
class RansDecoder {
 public:
  explicit RansDecoder(std::span<const std::uint8_t> words)
      : next_(words.data()), end_(words.data() + words.size() / 2 * 2) {
    state_ = static_cast<std::uint32_t>(Word()) << 16;
    state_ |= Word();
  }

  template <std::size_t kContexts>
  std::uint32_t Get(const DecodeTables<kContexts>& tables, std::size_t context) {
    const std::uint32_t slot = state_ & (kScale - 1);
    const std::uint32_t symbol = tables.SymbolOf(context, slot);
    const auto place = tables.PlaceOf(context, symbol);
    state_ = place.frequency * (state_ >> kScaleBits) + slot - place.start;
    if (state_ < kMinState) state_ = state_ << 16 | Word();
    return symbol;
  }

  bool ok() const { return ok_; }
  /// True if all words were used and the state is what encoding started with.
  bool AtEnd() const { return next_ == end_ && state_ == kMinState; }

 private:
  std::uint32_t Word() {
    if (next_ == end_) [[unlikely]] {
      ok_ = false;
      return 0;
    }
    const std::uint32_t word = next_[0] | static_cast<std::uint32_t>(next_[1]) << 8;
    next_ += 2;
    return word;
  }

  std::uint32_t state_ = 0;
  const std::uint8_t* next_;
  const std::uint8_t* end_;
  bool ok_ = true;
};

}  // namespace isotherm::codec
