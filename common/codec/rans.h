#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "common/codec/byte_io.h"

/// Range asymmetric numeral systems (Duda, "Asymmetric numeral systems", arXiv:1311.2540,
/// section 2.3): an entropy coder as dense as arithmetic coding with a multiplication per symbol.
/// State 32 bits in [2^16, 2^32), written in 16-bit words; frequencies are fixed per payload and
/// add up to 2^12.
namespace isotherm::codec {

inline constexpr unsigned kScaleBits = 12;
inline constexpr std::uint32_t kScale = 1U << kScaleBits;
inline constexpr std::uint32_t kLeastState = 1U << 16;

/// Scales `counts` so that they add up to kScale and no symbol that occurs gets 0. All zero stays
/// all zero.
void NormalizeCounts(std::span<const std::uint32_t> counts, std::span<std::uint16_t> frequencies);

void PutFrequencies(std::span<const std::uint16_t> frequencies, std::vector<std::uint8_t>& out);
/// False unless they add up to kScale or are all zero.
bool GetFrequencies(PayloadReader& in, std::span<std::uint16_t> frequencies);

/// What the encoder needs to know about a symbol.
struct EncodeSymbol {
  /// ceil(2^44 / frequency): with x < 2^20 * frequency, x * reciprocal stays below 2^64 and
  /// (x * reciprocal) >> 44 is exactly x / frequency.
  std::uint64_t reciprocal = 0;
  std::uint32_t frequency = 0;
  std::uint32_t start = 0;
};
inline constexpr unsigned kReciprocalBits = 44;

void MakeEncodeSymbols(std::span<const std::uint16_t> frequencies, std::span<EncodeSymbol> symbols);

/// Encodes backwards: the last symbol first. Thread-compatible.
class RansEncoder {
 public:
  /// `words` is filled from its end.
  explicit RansEncoder(std::uint16_t* end) : next_(end) {}

  void Put(const EncodeSymbol& symbol) {
    if (state_ >= static_cast<std::uint64_t>(symbol.frequency) << (32 - kScaleBits)) {
      *--next_ = static_cast<std::uint16_t>(state_);
      state_ >>= 16;
    }
    const auto quotient =
        static_cast<std::uint32_t>((state_ * symbol.reciprocal) >> kReciprocalBits);
    state_ += quotient * (kScale - symbol.frequency) + symbol.start;
  }

  /// The first of the words, two of which are the state.
  const std::uint16_t* Finish() {
    *--next_ = static_cast<std::uint16_t>(state_);
    *--next_ = static_cast<std::uint16_t>(state_ >> 16);
    return next_;
  }

 private:
  std::uint64_t state_ = kLeastState;
  std::uint16_t* next_;
};

/// Symbols below 256. Lookup of the symbol by slot, then of its place.
template <std::size_t kSymbols>
struct DecodeTable {
  std::array<std::uint8_t, kScale> symbol_of_slot;
  std::array<std::uint16_t, kSymbols> frequency;
  std::array<std::uint16_t, kSymbols> start;
};

template <std::size_t kSymbols>
void MakeDecodeTable(std::span<const std::uint16_t> frequencies, DecodeTable<kSymbols>& table) {
  std::uint32_t start = 0;
  for (std::size_t symbol = 0; symbol < kSymbols; ++symbol) {
    table.frequency[symbol] = frequencies[symbol];
    table.start[symbol] = static_cast<std::uint16_t>(start);
    for (std::uint32_t i = 0; i < frequencies[symbol]; ++i) {
      table.symbol_of_slot[start + i] = static_cast<std::uint8_t>(symbol);
    }
    start += frequencies[symbol];
  }
}

/// Reads little-endian words. Behind their end it reads zeros and ok() is false. Thread-compatible.
class RansDecoder {
 public:
  explicit RansDecoder(std::span<const std::uint8_t> words)
      : next_(words.data()), end_(words.data() + words.size() / 2 * 2) {
    state_ = static_cast<std::uint32_t>(Word()) << 16;
    state_ |= Word();
  }

  template <std::size_t kSymbols>
  std::uint32_t Get(const DecodeTable<kSymbols>& table) {
    const std::uint32_t slot = state_ & (kScale - 1);
    const std::uint32_t symbol = table.symbol_of_slot[slot];
    state_ = table.frequency[symbol] * (state_ >> kScaleBits) + slot - table.start[symbol];
    if (state_ < kLeastState) state_ = state_ << 16 | Word();
    return symbol;
  }

  bool ok() const { return ok_; }
  /// True if all words were used and the state is what encoding started with.
  bool AtEnd() const { return next_ == end_ && state_ == kLeastState; }

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
