#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>

#include "common/codec/bit_stream.h"
#include "common/codec/padded_image.h"
#include "common/codec/prediction.h"
#include "common/codec/rans.h"

namespace isotherm::codec {

/// Unpacks images that were packed in two halves, upper and lower. Keeps its memory from image to
/// image. Thread-compatible.
///
///   payload = frequencies of each context, upper half, lower half
///   half    = number of words, number of bytes of raw bits, words, raw bits
template <typename Model>
class HalvesDecoder {
 public:
  /// False if the payload does not fit the image. Leaves the pixels in image().
  bool Decode(PayloadReader& in, int width, int height) {
    for (std::size_t context = 0; context < kContexts<Model>; ++context) {
      std::array<std::uint16_t, kTokens<Model>> frequencies;
      if (!GetFrequencies(in, frequencies)) return false;
      tables_->Set(context, frequencies);
    }
    std::optional<Half> upper = GetHalf(in);
    if (!upper) return false;
    std::optional<Half> lower = GetHalf(in);
    if (!lower || !in.AtEnd()) return false;
    image_.Reset(width, height);
    if constexpr (Model::kHasHoles) filled_.Reset(width, height);
    DecodeRows(*upper, *lower);
    return upper->AtEnd() && lower->AtEnd();
  }

  PaddedImage& image() { return image_; }

 private:
  using Tables = DecodeTables<kContexts<Model>>;

  /// Reads the tokens and the raw bits of one of an image's halves.
  struct Half {
    RansDecoder tokens;
    BitReader bits;

    bool AtEnd() const { return tokens.ok() && bits.ok() && tokens.AtEnd() && bits.AtEnd(); }
  };

  /// The rows that pixels are read from and written to; `filled` are the same as the others in a
  /// model without holes.
  struct Rows {
    std::uint16_t* row;
    const std::uint16_t* above;
    std::uint16_t* filled;
    const std::uint16_t* filled_above;
  };

  static std::optional<Half> GetHalf(PayloadReader& in) {
    const std::optional<std::uint32_t> words = in.Varint();
    const std::optional<std::uint32_t> bits = in.Varint();
    if (!words || !bits) return std::nullopt;
    const auto word_bytes = in.Bytes(std::size_t{*words} * sizeof(std::uint16_t));
    if (!word_bytes) return std::nullopt;
    const auto bit_bytes = in.Bytes(*bits);
    if (!bit_bytes) return std::nullopt;
    return Half{.tokens = RansDecoder(*word_bytes), .bits = BitReader(*bit_bytes)};
  }

  /// One row of each half at a time: the processor overlaps the two chains of dependent pixels.
  void DecodeRows(Half& upper_half, Half& lower_half) {
    Half upper = upper_half;  // Local, so that they stay in registers.
    Half lower = lower_half;
    const int width = image_.width();
    int y = 0;
    for (int z = image_.FirstRow(1); z < image_.EndRow(1); ++y, ++z) {
      const Rows rows = BeginRow(y);
      const Rows low_rows = BeginRow(z);
      for (int x = 1; x <= width; ++x) {
        DecodePixel(*tables_, upper, rows, x);
        DecodePixel(*tables_, lower, low_rows, x);
      }
      EndRow(y);
      EndRow(z);
    }
    if (y < image_.EndRow(0)) {  // Of an odd number of rows the upper half has one more.
      const Rows rows = BeginRow(y);
      for (int x = 1; x <= width; ++x) DecodePixel(*tables_, upper, rows, x);
    }
    upper_half = upper;
    lower_half = lower;
  }

  Rows BeginRow(int y) {
    PaddedImage& values = Model::kHasHoles ? filled_ : image_;
    image_.PadLeft(y);
    values.PadLeft(y);
    return {.row = image_.Row(y),
            .above = image_.RowAbove(y),
            .filled = values.Row(y),
            .filled_above = values.RowAbove(y)};
  }

  void EndRow(int y) {
    image_.PadRight(y);
    if constexpr (Model::kHasHoles) filled_.PadRight(y);
  }

  static void DecodePixel(const Tables& tables, Half& half, const Rows& rows, int x) {
    const Neighbours neighbours{.west = rows.filled[x - 1],
                                .north = rows.filled_above[x],
                                .north_west = rows.filled_above[x - 1],
                                .north_east = rows.filled_above[x + 1]};
    const int context =
        Context<Model>(BitWidth(Activity(neighbours)), rows.row[x - 1] == 0, rows.above[x] == 0);
    std::uint32_t token = half.tokens.Get(tables, static_cast<std::size_t>(context));
    if constexpr (Model::kHasHoles) {
      if (token == 0) {
        rows.row[x] = 0;
        rows.filled[x] = rows.filled_above[x];
        return;
      }
      --token;
    }
    const TokenRange range = kTokenRanges[token];
    int residual = range.base;
    if (!Model::kRawBitsAreRare || range.raw_bits != 0) {
      residual += static_cast<int>(half.bits.Get(range.raw_bits));
    }
    const auto pixel = static_cast<std::uint16_t>(Model::Predict(neighbours) + UnZigZag(residual));
    rows.row[x] = pixel;
    if constexpr (Model::kHasHoles) rows.filled[x] = pixel;
  }

  const std::unique_ptr<Tables> tables_ = std::make_unique<Tables>();
  PaddedImage image_;
  PaddedImage filled_;  ///< The same without holes.
};

}  // namespace isotherm::codec
