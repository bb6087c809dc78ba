#pragma once

#include <cstdint>

/// How images are cut and packed by the strip codes (docs/codec.md). An image is 16 strips of equal
/// height, each packed with a coder of its own, so that a vector instruction works on a pixel of
/// each, and what is lost of one spoils no other.
namespace isotherm::codec {

/// Fixed by the format. More would predict more rows without a row above them, and fewer leave
/// lanes of wide vectors empty.
inline constexpr int kStrips = 16;

/// Returns the rows of each strip; the last strips may have fewer or none.
constexpr int StripRows(int height) { return (height + kStrips - 1) / kStrips; }

/// Returns how many strips have a row number `row`: the first ones.
constexpr int StripsWithRow(int height, int row) {
  const int rows = StripRows(height);
  return (height - row + rows - 1) / rows;
}

/// The coders' states lie in [2^15, 2^31), so that they are positive as signed numbers, and take
/// and give words of 16 bits. Encoding begins, and decoding ends, with the smallest.
inline constexpr int kMinStripState = 1 << 15;

/// A token gives a word at most, and so do the bits that follow it.
inline constexpr int kWordsPerPixel = 2;

/// Holds what decoding knows of a slot of a context's 2^10: the token, its frequency, and the
/// slot's number minus the token's first.
struct SlotLayout {
  static constexpr int kTokenMask = 0x7F;
  static constexpr int kFrequencyShift = 7;
  static constexpr int kFrequencyMask = 0x7FF;
  static constexpr int kOffsetShift = 18;
};

/// Holds what encoding knows of a token in a context: its frequency, its first slot, and how many
/// bits of the residual follow it.
struct SymbolLayout {
  static constexpr int kFrequencyMask = 0x7FF;
  static constexpr int kStartShift = 11;
  static constexpr int kStartMask = 0x3FF;
  static constexpr int kRawBitsShift = 21;
};

}  // namespace isotherm::codec
