#include "common/codec/tokenize_row.h"

namespace isotherm::codec {
namespace {

/// No branches, so that the compiler makes vector instructions of it.
template <typename Model>
[[gnu::always_inline]] inline void TokenizeRowInline(const RowToTokenize& row) {
  const int width = row.width;
  const std::uint16_t* const pixels = row.pixels;
  const std::uint16_t* const pixels_above = row.pixels_above;
  const std::uint16_t* const filled = row.filled;
  const std::uint16_t* const filled_above = row.filled_above;
  std::uint16_t* const symbols = row.symbols;
  std::uint16_t* const residuals = row.residuals;
  std::uint16_t* const raw_bits = row.raw_bits;
  // Inputs and outputs do not overlap. Clang has no such word: it looks whether they do.
#ifndef __clang__
#pragma GCC ivdep
#endif
  for (int x = 0; x < width; ++x) {
    const int pixel = pixels[x + 1];
    const Neighbours neighbours{.west = filled[x],
                                .north = filled_above[x + 1],
                                .north_west = filled_above[x],
                                .north_east = filled_above[x + 2]};
    const int context = Context<Model>(BitWidthForVectors(Activity(neighbours)), pixels[x] == 0,
                                       pixels_above[x + 1] == 0);
    const int residual = ZigZag(pixel - Model::Predict(neighbours));
    Token token = TokenOf(residual);
    if constexpr (Model::kHasHoles) {
      token.token = pixel == 0 ? 0 : token.token + 1;
      token.raw_bits = pixel == 0 ? 0 : token.raw_bits;
    }
    symbols[x] = static_cast<std::uint16_t>(context * kTokens<Model> + token.token);
    residuals[x] = static_cast<std::uint16_t>(residual);
    raw_bits[x] = static_cast<std::uint16_t>(token.raw_bits);
  }
}

#ifdef __x86_64__
template <typename Model>
[[gnu::target("avx2")]] void TokenizeRowAvx2(const RowToTokenize& row) {
  TokenizeRowInline<Model>(row);
}
const bool kHasAvx2 = __builtin_cpu_supports("avx2") != 0;
#endif

}  // namespace

template <typename Model>
void TokenizeRow(const RowToTokenize& row) {
#ifdef __x86_64__
  if (kHasAvx2) return TokenizeRowAvx2<Model>(row);
#endif
  TokenizeRowInline<Model>(row);
}

template void TokenizeRow<DepthModel>(const RowToTokenize& row);
template void TokenizeRow<ThermalModel>(const RowToTokenize& row);

}  // namespace isotherm::codec
