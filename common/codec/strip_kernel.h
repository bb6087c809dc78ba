#pragma once

#include <cstddef>
#include <cstdint>

#include "common/codec/prediction.h"
#include "common/codec/strip_layout.h"

/// The inner loops of the strip codes. They work on one row of all strips at a time, whose pixels
/// are interleaved: that of strip i in column x is cell kStrips x + i. Arrays have kStrips cells
/// for each column, and one column more where said.
namespace isotherm::codec {

/// A row that is coded and the one above it in each strip. `filled` is the same without holes: a
/// hole has the value above it; for models without holes it is the row itself.
struct StripRow {
  int width = 0;
  bool is_first = false;                        ///< There is no row above.
  std::uint16_t* row = nullptr;                 ///< With a column more. 0 = hole.
  std::uint16_t* filled = nullptr;              ///< With a column more.
  const std::uint16_t* above = nullptr;         ///< With a column more.
  const std::uint16_t* filled_above = nullptr;  ///< With a column more.
};

/// Holds what is made of a row before it is coded.
struct StripTokens {
  std::uint16_t* symbols = nullptr;    ///< Context x number of tokens + token.
  std::uint16_t* residuals = nullptr;  ///< ZigZag values.
};

/// Finds the tokens of a row, and fills its holes.
template <typename Model>
void TokenizeStripRow(const StripRow& row, const StripTokens& tokens);

/// Codes a row backwards, in its first `strips` strips, whose coders' `states` (one for each of
/// kStrips) it changes. `symbol_table` holds SymbolLayout's by symbol. Returns how many words it
/// gives; each is in the low half of one of `words`, its strip's number in the high half; a strip's
/// are in the order they were given, which is from its end to its beginning. There must be room for
/// kWordsPerPixel words a pixel of all kStrips, and kStrips more.
std::size_t EncodeStripRow(const StripTokens& tokens, int width, int strips,
                           const std::int32_t* symbol_table, std::int32_t* states,
                           std::int32_t* words);

/// Where the strips' decoders are.
struct StripDecoderState {
  alignas(64) std::int32_t states[kStrips] = {};
  alignas(64) std::int32_t positions[kStrips] = {};  ///< Next word of each.
};

/// Holds what decoding needs beside its state. Beyond `last_word`, which is never a strip's, none
/// is read.
struct StripWords {
  const std::int32_t* slots = nullptr;  ///< SlotLayout's by context x 2^10 + slot.
  const std::int32_t* words = nullptr;  ///< Two words each, the first in the low half.
  std::int32_t last_word = 0;
};

/// Decodes a row of the first `strips` strips into row and filled; of others nothing is meant.
template <typename Model>
void DecodeStripRow(const StripWords& words, int strips, const StripRow& row,
                    StripDecoderState& state);

}  // namespace isotherm::codec
