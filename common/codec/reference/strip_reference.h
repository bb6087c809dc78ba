#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "common/codec/byte_io.h"
#include "common/codec/prediction.h"
#include "common/codec/rans.h"
#include "common/codec/residual_token.h"
#include "common/codec/strip_layout.h"
#include "common/frame/image.h"

/// The strip codes for one pixel after the other: the specification of strip_kernel.h.
namespace isotherm::codec::reference {

/// One strip of an image.
struct Strip {
  int first_row = 0;
  int end_row = 0;
};
inline Strip StripOf(int height, int strip) {
  const int rows = StripRows(height);
  return {std::min(strip * rows, height), std::min((strip + 1) * rows, height)};
}

/// Holds what is known of a pixel before it is decoded.
struct Known {
  Neighbours neighbours;  ///< Without holes.
  bool hole_west = false;
  bool hole_north = false;
};

/// `filled` is `image` without holes. The pixel to the west stands for those that are missing above
/// a strip's first row, the one above for those that are missing to the west and the east.
inline Known KnownOf(const Image<std::uint16_t>& image, const Image<std::uint16_t>& filled,
                     int first_row, int x, int y) {
  const bool has_west = x > 0;
  if (y == first_row) {
    const int west = has_west ? filled.At(x - 1, y) : 0;
    const bool hole = !has_west || image.At(x - 1, y) == 0;
    return {{west, west, west, west}, hole, hole};
  }
  const int north = filled.At(x, y - 1);
  const bool hole_north = image.At(x, y - 1) == 0;
  const bool has_east = x + 1 < image.width();
  return {{.west = has_west ? filled.At(x - 1, y) : north,
           .north = north,
           .north_west = has_west ? filled.At(x - 1, y - 1) : north,
           .north_east = has_east ? filled.At(x + 1, y - 1) : north},
          has_west ? image.At(x - 1, y) == 0 : hole_north,
          hole_north};
}

template <typename Model>
int ContextOf(const Known& known) {
  return Context<Model>(BitWidth(Activity(known.neighbours)), known.hole_west, known.hole_north);
}

/// A pixel as the entropy coder takes it.
struct CodedPixel {
  std::size_t context = 0;
  std::size_t token = 0;
  std::uint32_t raw = 0;
  int raw_bits = 0;
};

/// The pixels of a strip in order; fills its holes in `filled`.
template <typename Model>
std::vector<CodedPixel> CodePixels(const Image<std::uint16_t>& image, const Strip& strip,
                                   Image<std::uint16_t>& filled) {
  std::vector<CodedPixel> coded;
  for (int y = strip.first_row; y < strip.end_row; ++y) {
    for (int x = 0; x < image.width(); ++x) {
      const Known known = KnownOf(image, filled, strip.first_row, x, y);
      const int pixel = image.At(x, y);
      const bool hole = Model::kHasHoles && pixel == 0;
      filled.At(x, y) = static_cast<std::uint16_t>(hole ? known.neighbours.north : pixel);
      const int residual = ZigZag(pixel - Model::Predict(known.neighbours));
      const Token token = hole ? Token{.token = -1, .raw_bits = 0} : TokenOf(residual);
      coded.push_back({static_cast<std::size_t>(ContextOf<Model>(known)),
                       static_cast<std::size_t>(token.token + (Model::kHasHoles ? 1 : 0)),
                       static_cast<std::uint32_t>(residual) & ((1U << token.raw_bits) - 1U),
                       token.raw_bits});
    }
  }
  return coded;
}

/// An entropy coder's frequencies and first slots by context and token.
template <typename Model>
struct Tables {
  std::array<std::array<std::uint16_t, kTokens<Model>>, kContexts<Model>> frequencies{};

  std::uint32_t Start(std::size_t context, std::size_t token) const {
    std::uint32_t start = 0;
    for (std::size_t i = 0; i < token; ++i) start += frequencies[context][i];
    return start;
  }
};

/// The words of a strip, the state's two first.
template <typename Model>
std::vector<std::uint16_t> EncodeStrip(const std::vector<CodedPixel>& pixels,
                                       const Tables<Model>& tables) {
  std::vector<std::uint16_t> words;  // The last one first.
  std::uint64_t state = kMinStripState;
  const auto give_word_from = [&](std::uint64_t limit) {
    if (state < limit) return;
    words.push_back(static_cast<std::uint16_t>(state));
    state >>= 16;
  };
  for (std::size_t i = pixels.size(); i-- > 0;) {
    const CodedPixel& pixel = pixels[i];
    if (pixel.raw_bits > 0) {
      give_word_from(std::uint64_t{1} << (31 - pixel.raw_bits));
      state = state << pixel.raw_bits | pixel.raw;
    }
    const std::uint32_t frequency = tables.frequencies[pixel.context][pixel.token];
    give_word_from(std::uint64_t{frequency} << (31 - kScaleBits));
    state = (state / frequency << kScaleBits) + state % frequency +
            tables.Start(pixel.context, pixel.token);
  }
  words.push_back(static_cast<std::uint16_t>(state));
  words.push_back(static_cast<std::uint16_t>(state >> 16));
  std::ranges::reverse(words);
  return words;
}

/// Packs an image whose pixels are as they shall be packed.
template <typename Model>
std::vector<std::uint8_t> Encode(const Image<std::uint16_t>& image) {
  Image<std::uint16_t> filled(image.width(), image.height());
  std::vector<std::vector<CodedPixel>> strips;
  std::array<std::array<std::uint32_t, kTokens<Model>>, kContexts<Model>> counts{};
  for (int i = 0; i < kStrips; ++i) {
    strips.push_back(CodePixels<Model>(image, StripOf(image.height(), i), filled));
    for (const CodedPixel& pixel : strips.back()) ++counts[pixel.context][pixel.token];
  }
  Tables<Model> tables;
  std::vector<std::uint8_t> out;
  for (std::size_t context = 0; context < kContexts<Model>; ++context) {
    NormalizeCounts(counts[context], tables.frequencies[context]);
    PutFrequencies(tables.frequencies[context], out);
  }
  std::vector<std::uint8_t> bytes;
  for (const std::vector<CodedPixel>& pixels : strips) {
    const std::vector<std::uint16_t> words = EncodeStrip(pixels, tables);
    PutVarint(static_cast<std::uint32_t>(words.size()), out);
    for (const std::uint16_t word : words) {
      bytes.push_back(static_cast<std::uint8_t>(word));
      bytes.push_back(static_cast<std::uint8_t>(word >> 8));
    }
  }
  out.insert(out.end(), bytes.begin(), bytes.end());
  return out;
}

}  // namespace isotherm::codec::reference
