#include "common/codec/strip_encoder.h"

#include <algorithm>
#include <functional>
#include <span>

#include "common/codec/byte_io.h"
#include "common/codec/rans.h"
#include "common/codec/residual_token.h"
#include "common/codec/strip_kernel.h"

namespace isotherm::codec {
namespace {

/// Copies a row of each strip of an image between its pixels.
void Interleave(const Image<std::uint16_t>& image, int row, const std::uint16_t* mapping,
                std::uint16_t* cells) {
  const int rows = StripRows(image.height());
  const int strips = StripsWithRow(image.height(), row);
  for (int strip = 0; strip < strips; ++strip) {
    std::uint16_t* cell = cells + strip;
    for (const std::uint16_t pixel : image.Row(strip * rows + row)) {
      *cell = mapping != nullptr ? mapping[pixel] : pixel;
      cell += kStrips;
    }
  }
}

/// SymbolLayout's words of a context's tokens.
void MakeSymbols(std::span<const std::uint16_t> frequencies, int raw_bits_of_first_token,
                 std::span<std::int32_t> symbols) {
  int start = 0;
  for (std::size_t token = 0; token < frequencies.size(); ++token) {
    const int number = static_cast<int>(token) - raw_bits_of_first_token;
    const int raw_bits = number < 0 ? 0 : kTokenRanges[static_cast<std::size_t>(number)].raw_bits;
    symbols[token] = frequencies[token] |
                     (start & SymbolLayout::kStartMask) << SymbolLayout::kStartShift |
                     raw_bits << SymbolLayout::kRawBitsShift;
    start += frequencies[token];
  }
}

void PutWords(std::span<const std::uint16_t> words, std::vector<std::uint8_t>& out) {
  const std::size_t begin = out.size();
  out.resize(begin + words.size() * sizeof(std::uint16_t));
  std::uint8_t* byte = out.data() + begin;
  for (const std::uint16_t word : words) {
    *byte++ = static_cast<std::uint8_t>(word);
    *byte++ = static_cast<std::uint8_t>(word >> 8);
  }
}

}  // namespace

template <typename Model>
void StripEncoder<Model>::Encode(const Image<std::uint16_t>& image, const std::uint16_t* mapping,
                                 std::vector<std::uint8_t>& out) {
  Reserve(image.width(), image.height());
  Tokenize(image, mapping);
  PutTables(out);
  PutStrips(image.height(), out);
}

template <typename Model>
void StripEncoder<Model>::Reserve(int width, int height) {
  width_ = width;
  const std::size_t pixels_per_strip =
      static_cast<std::size_t>(width) * static_cast<std::size_t>(StripRows(height));
  symbols_.resize(pixels_per_strip * kStrips);
  residuals_.resize(pixels_per_strip * kStrips);
  row_words_.resize((kWordsPerPixel * static_cast<std::size_t>(width) + 1) * kStrips);
  // The coder's state takes two more.
  const std::size_t words_per_strip = kWordsPerPixel * pixels_per_strip + 2;
  if (words_per_strip == words_per_strip_) return;
  words_per_strip_ = words_per_strip;
  words_ = std::make_unique_for_overwrite<std::uint16_t[]>(words_per_strip * kStrips);
}

template <typename Model>
StripTokens StripEncoder<Model>::TokensOfRow(int row) {
  const std::size_t first =
      static_cast<std::size_t>(row) * static_cast<std::size_t>(width_) * kStrips;
  return {.symbols = symbols_.data() + first, .residuals = residuals_.data() + first};
}

template <typename Model>
void StripEncoder<Model>::Tokenize(const Image<std::uint16_t>& image,
                                   const std::uint16_t* mapping) {
  counts_ = {};
  rows_.Reset(width_);
  for (int row = 0; row < StripRows(image.height()); ++row) {
    const StripRow now = rows_.Get();
    Interleave(image, row, mapping, now.row);
    const StripTokens tokens = TokensOfRow(row);
    TokenizeStripRow<Model>(now, tokens);
    Count(tokens.symbols, StripsWithRow(image.height(), row));
    rows_.Next();
  }
}

template <typename Model>
void StripEncoder<Model>::Count(const std::uint16_t* symbols, int strips) {
  auto& [a, b, c, d] = counts_;
  for (int x = 0; x < width_; ++x, symbols += kStrips) {
    int strip = 0;
    for (; strip + 4 <= strips; strip += 4) {
      ++a[symbols[strip]];
      ++b[symbols[strip + 1]];
      ++c[symbols[strip + 2]];
      ++d[symbols[strip + 3]];
    }
    for (; strip < strips; ++strip) ++a[symbols[strip]];
  }
}

template <typename Model>
void StripEncoder<Model>::PutTables(std::vector<std::uint8_t>& out) {
  for (std::size_t i = 1; i < counts_.size(); ++i)
    std::ranges::transform(counts_[0], counts_[i], counts_[0].begin(), std::plus<>());
  std::array<std::uint16_t, kTokens<Model>> frequencies;
  for (std::size_t context = 0; context < kContexts<Model>; ++context) {
    const std::size_t first = context * kTokens<Model>;
    NormalizeCounts(std::span(counts_[0]).subspan(first, kTokens<Model>), frequencies);
    MakeSymbols(frequencies, Model::kHasHoles ? 1 : 0,
                std::span(table_).subspan(first, kTokens<Model>));
    PutFrequencies(frequencies, out);
  }
}

template <typename Model>
void StripEncoder<Model>::PutStrips(int height, std::vector<std::uint8_t>& out) {
  alignas(64) std::array<std::int32_t, kStrips> states;
  states.fill(kMinStripState);
  std::array<std::uint16_t*, kStrips> ends, begins;
  for (std::size_t strip = 0; strip < kStrips; ++strip)
    begins[strip] = ends[strip] = words_.get() + (strip + 1) * words_per_strip_;
  for (int row = StripRows(height) - 1; row >= 0; --row) {
    const std::size_t count = EncodeStripRow(TokensOfRow(row), width_, StripsWithRow(height, row),
                                             table_.data(), states.data(), row_words_.data());
    for (const std::int32_t word : std::span(row_words_).first(count))
      *--begins[static_cast<std::size_t>(word >> 16)] = static_cast<std::uint16_t>(word);
  }
  for (std::size_t strip = 0; strip < kStrips; ++strip) {
    *--begins[strip] = static_cast<std::uint16_t>(states[strip]);
    *--begins[strip] = static_cast<std::uint16_t>(states[strip] >> 16);
    PutVarint(static_cast<std::uint32_t>(ends[strip] - begins[strip]), out);
  }
  for (std::size_t strip = 0; strip < kStrips; ++strip) PutWords({begins[strip], ends[strip]}, out);
}

template class StripEncoder<DepthModel>;
template class StripEncoder<ThermalModel>;

}  // namespace isotherm::codec
