#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "common/base/check.h"
#include "common/codec/bit_stream.h"
#include "common/codec/rans.h"
#include "common/codec/residual_token.h"

/// What both image codes share: each pixel is predicted from its west, north, north-west and
/// north-east neighbours; the difference becomes a token and raw bits; the tokens are entropy coded
/// with frequencies that depend on a context, which the same neighbours give. A model supplies
/// prediction and context:
///
///   static constexpr std::uint32_t kContexts;
///   static constexpr bool kHasHoles;  // Value 0 is no measurement: it has a token of its own.
///   static Prediction Predict(std::uint32_t w, std::uint32_t n, std::uint32_t nw, std::uint32_t
///   ne);
///
/// An image is two strips, upper and lower half, that do not depend on each other, so that a
/// processor can work on two pixels at once.
namespace isotherm::codec {

struct Prediction {
  std::uint32_t value = 0;
  std::uint32_t context = 0;
};

inline constexpr int kStrips = 2;

/// Image with one column of padding on either side: cells 0 and width + 1 of each row. Rows of
/// zeros stand above each strip.
class PaddedImage {
 public:
  void Reset(int width, int height) {
    width_ = width;
    height_ = height;
    cells_.resize((static_cast<std::size_t>(height) + 1) * stride());
    std::fill_n(cells_.begin(), stride(), std::uint16_t{0});
  }
  int width() const { return width_; }
  int FirstRow(int strip) const { return strip == 0 ? 0 : (height_ + 1) / kStrips; }
  int EndRow(int strip) const { return strip == 0 ? FirstRow(1) : height_; }

  std::uint16_t* Row(int y) { return cells_.data() + (static_cast<std::size_t>(y) + 1) * stride(); }
  /// The row that predicts row `y`.
  const std::uint16_t* RowAbove(int y) {
    return y == FirstRow(1) ? cells_.data() : Row(y) - stride();
  }
  /// Call before a row is coded ...
  void PadLeft(int y) { Row(y)[0] = RowAbove(y)[1]; }
  /// ... and when it is complete.
  void PadRight(int y) { Row(y)[width_ + 1] = Row(y)[width_]; }

 private:
  std::size_t stride() const { return static_cast<std::size_t>(width_) + 2; }

  int width_ = 0;
  int height_ = 0;
  std::vector<std::uint16_t> cells_;
};

template <typename Model>
inline constexpr std::uint32_t kTokens = kResidualTokens + (Model::kHasHoles ? 1 : 0);

/// Keeps its memory from image to image. Thread-compatible.
template <typename Model>
class PredictiveEncoder {
 public:
  /// Fill all its rows, then call Encode().
  PaddedImage& image() { return image_; }

  void Encode(int width, int height, std::vector<std::uint8_t>& out) {
    symbols_.resize(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
    counts_.fill(0);
    for (int strip = 0; strip < kStrips; ++strip) Tokenize(strip);
    for (std::uint32_t context = 0; context < Model::kContexts; ++context) {
      const std::size_t first = context * kTokens<Model>;
      NormalizeCounts(std::span(counts_).subspan(first, kTokens<Model>), frequencies_);
      MakeEncodeSymbols(frequencies_, std::span(table_).subspan(first, kTokens<Model>));
      PutFrequencies(frequencies_, out);
    }
    PutStrips(out);
  }

 private:
  static constexpr std::size_t kTableSize = Model::kContexts * kTokens<Model>;

  void Tokenize(int strip) {
    BitWriter& bits = bits_[static_cast<std::size_t>(strip)];
    bits.Clear();
    const int width = image_.width();
    std::uint16_t* symbol = symbols_.data() + FirstSymbol(strip);
    for (int y = image_.FirstRow(strip); y < image_.EndRow(strip); ++y) {
      image_.PadLeft(y);
      image_.PadRight(y);
      const std::uint16_t* const row = image_.Row(y);
      const std::uint16_t* const above = image_.RowAbove(y);
      for (int x = 1; x <= width; ++x) {
        const Prediction prediction =
            Model::Predict(row[x - 1], above[x], above[x - 1], above[x + 1]);
        *symbol = static_cast<std::uint16_t>(prediction.context * kTokens<Model> +
                                             PutResidual(row[x], prediction.value, bits));
        ++counts_[*symbol++];
      }
    }
  }

  static std::uint32_t PutResidual(std::uint16_t pixel, std::uint32_t predicted, BitWriter& bits) {
    if constexpr (Model::kHasHoles) {
      if (pixel == 0) return 0;
    }
    const std::uint32_t value = ZigZag(static_cast<std::uint16_t>(pixel - predicted));
    const std::uint32_t token = value < kTabulatedValues ? kTokenTable[value] : TokenOf(value);
    const TokenRange range = kTokenRanges[token];
    bits.Put(value - range.base, range.bits);
    return Model::kHasHoles ? token + 1 : token;
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
    RansEncoder upper(middle_word);
    RansEncoder lower(words_.data() + words_.size());
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
    PutStrip({lower_begin, std::to_address(words_.end())}, bits_[1], out);
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
  std::vector<std::uint16_t> symbols_;  ///< Context and token of each pixel.
  std::array<std::uint32_t, kTableSize> counts_{};
  std::array<std::uint16_t, kTokens<Model>> frequencies_{};
  std::array<EncodeSymbol, kTableSize> table_{};
  std::array<BitWriter, kStrips> bits_;
  std::vector<std::uint16_t> words_;
};

template <typename Model>
class PredictiveDecoder {
 public:
  /// False if the payload does not fit the image. Leaves the pixels in image().
  bool Decode(PayloadReader& in, int width, int height) {
    for (DecodeTable<kTokens<Model>>& table : *tables_) {
      std::array<std::uint16_t, kTokens<Model>> frequencies;
      if (!GetFrequencies(in, frequencies)) return false;
      MakeDecodeTable(frequencies, table);
    }
    auto upper = GetStrip(in);
    if (!upper) return false;
    auto lower = GetStrip(in);
    if (!lower || !in.AtEnd()) return false;
    image_.Reset(width, height);
    DecodeRows(*upper, *lower);
    return upper->AtEnd() && lower->AtEnd();
  }

  PaddedImage& image() { return image_; }

 private:
  using Tables = std::array<DecodeTable<kTokens<Model>>, Model::kContexts>;

  struct Strip {
    RansDecoder tokens;
    BitReader bits;

    bool AtEnd() const { return tokens.ok() && bits.ok() && tokens.AtEnd() && bits.AtEnd(); }
  };

  static std::optional<Strip> GetStrip(PayloadReader& in) {
    const std::optional<std::uint32_t> words = in.Varint();
    const std::optional<std::uint32_t> bits = in.Varint();
    if (!words || !bits) return std::nullopt;
    const auto word_bytes = in.Bytes(std::size_t{*words} * sizeof(std::uint16_t));
    if (!word_bytes) return std::nullopt;
    const auto bit_bytes = in.Bytes(*bits);
    if (!bit_bytes) return std::nullopt;
    return Strip{.tokens = RansDecoder(*word_bytes), .bits = BitReader(*bit_bytes)};
  }

  /// One row of each strip at a time: the processor overlaps the two chains of dependent pixels.
  void DecodeRows(Strip& upper_strip, Strip& lower_strip) {
    Strip upper = upper_strip;  // Local, so that they stay in registers.
    Strip lower = lower_strip;
    const int width = image_.width();
    int y = 0;
    for (int z = image_.FirstRow(1); z < image_.EndRow(1); ++y, ++z) {
      image_.PadLeft(y);
      image_.PadLeft(z);
      std::uint16_t* const row = image_.Row(y);
      std::uint16_t* const low_row = image_.Row(z);
      const std::uint16_t* const above = image_.RowAbove(y);
      const std::uint16_t* const low_above = image_.RowAbove(z);
      for (int x = 1; x <= width; ++x) {
        row[x] = DecodePixel(*tables_, upper, row[x - 1], above + x);
        low_row[x] = DecodePixel(*tables_, lower, low_row[x - 1], low_above + x);
      }
      image_.PadRight(y);
      image_.PadRight(z);
    }
    if (y < image_.EndRow(0)) {  // Of an odd number of rows the upper strip has one more.
      image_.PadLeft(y);
      std::uint16_t* const row = image_.Row(y);
      for (int x = 1; x <= width; ++x) {
        row[x] = DecodePixel(*tables_, upper, row[x - 1], image_.RowAbove(y) + x);
      }
    }
    upper_strip = upper;
    lower_strip = lower;
  }

  static std::uint16_t DecodePixel(const Tables& tables, Strip& strip, std::uint32_t west,
                                   const std::uint16_t* north) {
    const Prediction prediction = Model::Predict(west, north[0], north[-1], north[1]);
    std::uint32_t token = strip.tokens.Get(tables[prediction.context]);
    if constexpr (Model::kHasHoles) {
      if (token == 0) return 0;
      --token;
    }
    const TokenRange range = kTokenRanges[token];
    const std::uint32_t value = range.base + strip.bits.Get(range.bits);
    return static_cast<std::uint16_t>(prediction.value + UnZigZag(value));
  }

  std::unique_ptr<Tables> tables_ = std::make_unique<Tables>();
  PaddedImage image_;
};

}  // namespace isotherm::codec
