#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <utility>
#include <vector>

#include "common/codec/bit_stream.h"
#include "common/codec/padded_image.h"
#include "common/codec/prediction.h"
#include "common/codec/rans.h"
#include "common/codec/tokenize_row.h"

namespace isotherm::codec {

/// Packs an image: predicts, turns differences into tokens and raw bits, counts the tokens of each
/// context and entropy codes them. Keeps its memory from image to image. Thread-compatible.
///
///   payload = frequencies of each context, upper strip, lower strip
///   strip   = number of words, number of bytes of raw bits, words, raw bits
template <typename Model>
class PredictiveEncoder {
 public:
  /// Reset and fill all its rows, then call Encode().
  PaddedImage& image() { return image_; }

  void Encode(std::vector<std::uint8_t>& out) {
    const auto width = static_cast<std::size_t>(image_.width());
    symbols_.resize(width * static_cast<std::size_t>(image_.height()));
    residuals_.resize(width);
    raw_bits_.resize(width);
    counts_ = {};
    if constexpr (Model::kHasHoles) FillHoles();
    for (int strip = 0; strip < kStrips; ++strip) Tokenize(strip);
    PutFrequencyTables(out);
    PutStrips(out);
  }

 private:
  static constexpr std::size_t kTableSize = kContexts<Model> * kTokens<Model>;

  /// A hole is predicted over with the value above it.
  void FillHoles() {
    filled_.Reset(image_.width(), image_.height());
    for (int y = 0; y < image_.height(); ++y) {
      const int width = image_.width();
      const std::uint16_t* const row = image_.Row(y);
      const std::uint16_t* const above = filled_.RowAbove(y);
      std::uint16_t* __restrict const filled = filled_.Row(y);
      for (int x = 1; x <= width; ++x) {
        const std::uint16_t pixel = row[x];
        const std::uint16_t north = above[x];
        filled[x] = pixel == 0 ? north : pixel;
      }
    }
  }

  void Tokenize(int strip) {
    BitWriter bits = std::move(bits_[strip]);  // Local: stays in registers.
    bits.Reset(symbols_.size());
    std::uint16_t* symbols = symbols_.data() + FirstSymbol(strip);
    for (int y = image_.FirstRow(strip); y < image_.EndRow(strip); ++y) {
      FindTokens(y, symbols);
      PutRow(symbols, bits);
      symbols += image_.width();
    }
    bits_[strip] = std::move(bits);
  }

  void FindTokens(int y, std::uint16_t* symbols) {
    PaddedImage& filled = Model::kHasHoles ? filled_ : image_;
    for (PaddedImage* image : {&image_, &filled}) {
      image->PadLeft(y);
      image->PadRight(y);
    }
    TokenizeRow<Model>({.width = image_.width(),
                        .pixels = image_.Row(y),
                        .pixels_above = image_.RowAbove(y),
                        .filled = filled.Row(y),
                        .filled_above = filled.RowAbove(y),
                        .symbols = symbols,
                        .residuals = residuals_.data(),
                        .raw_bits = raw_bits_.data()});
  }

  void PutRow(const std::uint16_t* symbols, BitWriter& bits) {
    const int width = image_.width();
    for (int x = 0; x < width; ++x) {
      ++counts_[static_cast<std::size_t>(x & 1)][symbols[x]];
      const unsigned count = raw_bits_[x];
      if (Model::kRawBitsAreRare && count == 0) continue;
      bits.Put(residuals_[x] & ((1U << count) - 1U), count);
    }
  }

  void PutFrequencyTables(std::vector<std::uint8_t>& out) {
    std::ranges::transform(counts_[0], counts_[1], counts_[0].begin(), std::plus<>());
    std::array<std::uint16_t, kTokens<Model>> frequencies;
    for (std::size_t context = 0; context < kContexts<Model>; ++context) {
      const std::size_t first = context * kTokens<Model>;
      NormalizeCounts(std::span(counts_[0]).subspan(first, kTokens<Model>), frequencies);
      MakeEncodeSymbols(frequencies, std::span(table_).subspan(first, kTokens<Model>));
      PutFrequencies(frequencies, out);
    }
  }

  std::size_t FirstSymbol(int strip) const {
    return static_cast<std::size_t>(image_.FirstRow(strip)) *
           static_cast<std::size_t>(image_.width());
  }

  void PutStrips(std::vector<std::uint8_t>& out) {
    // A symbol takes at most one word; the state takes two more.
    words_.resize(symbols_.size() + 2 * kStrips);
    const std::size_t middle = FirstSymbol(1);
    std::uint16_t* const middle_word = words_.data() + middle + 2;
    std::uint16_t* const end_word = words_.data() + words_.size();
    RansEncoder upper(middle_word);
    RansEncoder lower(end_word);
    std::size_t i = middle;
    std::size_t j = symbols_.size();
    for (; i > 0 && j > middle; --i, --j) {
      upper.Put(table_[symbols_[i - 1]]);
      lower.Put(table_[symbols_[j - 1]]);
    }
    for (; i > 0; --i) upper.Put(table_[symbols_[i - 1]]);
    const std::uint16_t* const upper_begin = upper.Finish();
    const std::uint16_t* const lower_begin = lower.Finish();
    PutStrip({upper_begin, middle_word}, bits_[0], out);
    PutStrip({lower_begin, end_word}, bits_[1], out);
  }

  static void PutStrip(std::span<const std::uint16_t> words, BitWriter& bits,
                       std::vector<std::uint8_t>& out) {
    const std::span<const std::uint8_t> bit_bytes = bits.Finish();
    PutVarint(static_cast<std::uint32_t>(words.size()), out);
    PutVarint(static_cast<std::uint32_t>(bit_bytes.size()), out);
    const std::size_t begin = out.size();
    out.resize(begin + words.size() * sizeof(std::uint16_t));
    std::uint8_t* byte = out.data() + begin;
    for (const std::uint16_t word : words) {
      *byte++ = static_cast<std::uint8_t>(word);
      *byte++ = static_cast<std::uint8_t>(word >> 8);
    }
    out.insert(out.end(), bit_bytes.begin(), bit_bytes.end());
  }

  PaddedImage image_;
  PaddedImage filled_;                    ///< The same without holes.
  std::vector<std::uint16_t> symbols_;    ///< Context and token of each pixel.
  std::vector<std::uint16_t> residuals_;  ///< One per pixel of a row.
  std::vector<std::uint16_t> raw_bits_;   ///< One per pixel of a row.
  /// Counts of even and of odd pixels apart: to count the same twice in a row would wait for
  /// memory.
  std::array<std::array<std::uint32_t, kTableSize>, 2> counts_{};
  std::array<EncodeSymbol, kTableSize> table_{};
  std::array<BitWriter, kStrips> bits_;
  std::vector<std::uint16_t> words_;
};

}  // namespace isotherm::codec
