#pragma once

#include <cstdint>

#include "common/codec/prediction.h"

namespace isotherm::codec {

/// A row on its way from pixels to tokens. Inputs have a cell of padding on either side: pixel x is
/// cell x + 1.
struct RowToTokenize {
  int width = 0;
  const std::uint16_t* pixels = nullptr;
  const std::uint16_t* pixels_above = nullptr;
  const std::uint16_t* filled = nullptr;  ///< The same without holes.
  const std::uint16_t* filled_above = nullptr;
  std::uint16_t* symbols = nullptr;    ///< Context x number of tokens + token.
  std::uint16_t* residuals = nullptr;  ///< ZigZag values.
  std::uint16_t* raw_bits = nullptr;   ///< How many lowest bits of the residual follow the token.
};

/// With the vector instructions that this processor has.
template <typename Model>
void TokenizeRow(const RowToTokenize& row);

}  // namespace isotherm::codec
