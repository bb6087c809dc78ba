#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "common/codec/prediction.h"
#include "common/codec/strip_row_pair.h"
#include "common/frame/image.h"

namespace isotherm::codec {

/// Packs an image in strips (docs/codec.md). Keeps its memory from image to image.
/// Thread-compatible.
///
///   payload = frequencies of each context, number of words of each strip, words of each strip
template <typename Model>
class StripEncoder {
 public:
  /// Appends the payload of `image` to `out`, each pixel packed as mapping[pixel], or as it is if
  /// `mapping` is null.
  void Encode(const Image<std::uint16_t>& image, const std::uint16_t* mapping,
              std::vector<std::uint8_t>& out);

 private:
  static constexpr std::size_t kSymbols = kContexts<Model> * kTokens<Model>;

  void Reserve(int width, int height);
  StripTokens TokensOfRow(int row);
  void Tokenize(const Image<std::uint16_t>& image, const std::uint16_t* mapping);
  void Count(const std::uint16_t* symbols, int strips);
  void PutTables(std::vector<std::uint8_t>& out);
  void PutStrips(int height, std::vector<std::uint8_t>& out);

  int width_ = 0;
  StripRowPair<Model> rows_;
  std::vector<std::uint16_t> symbols_;    ///< Row by row, strips interleaved.
  std::vector<std::uint16_t> residuals_;  ///< As symbols_.
  /// Counts of neighbours apart: to count the same twice in a row would wait for memory.
  std::array<std::array<std::uint32_t, kSymbols>, 4> counts_{};
  std::array<std::int32_t, kSymbols> table_{};
  std::vector<std::int32_t> row_words_;  ///< One row's, as EncodeStripRow gives them.
  /// The strips' words, each strip's at the end of its part. Only what is written to takes memory.
  std::unique_ptr<std::uint16_t[]> words_;
  std::size_t words_per_strip_ = 0;
};

}  // namespace isotherm::codec
