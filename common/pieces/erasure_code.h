#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

/// Reed-Solomon code over bytes (GF(2^8), Cauchy matrix: Plank and Xu, 2006; the arithmetic is
/// ISA-L's): of k pieces of data and any number of parity pieces, any k are enough.
namespace isotherm {

using Bytes = std::vector<std::uint8_t>;

/// Pieces of data and parity of one code word together.
inline constexpr int kMaxCodeWord = 255;

/// Returns `rows` parity pieces of `data`, pieces of the same size; not more than kMaxCodeWord
/// together.
std::vector<Bytes> ParityOf(std::span<const Bytes> data, int rows);

/// Holds a piece that has arrived: data piece `row`, or parity piece `row` - k.
struct CodedPiece {
  int row = 0;
  std::span<const std::uint8_t> bytes;
};

/// Returns the k pieces of data from any k different pieces of the same size. Empty if rows repeat
/// or are out of range.
std::vector<Bytes> RecoverData(std::span<const CodedPiece> pieces);

}  // namespace isotherm
