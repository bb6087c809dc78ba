#include "common/pieces/erasure_code.h"

#include <isa-l/erasure_code.h>

#include <algorithm>
#include <array>
#include <functional>
#include <utility>

namespace isotherm {
namespace {

constexpr std::size_t kTableBytes = 32;  ///< A factor's, as ISA-L wants it.

/// The first k rows are those of the identity.
Bytes CodeMatrix(int rows, int k) {
  Bytes matrix(static_cast<std::size_t>(rows) * static_cast<std::size_t>(k));
  gf_gen_cauchy1_matrix(matrix.data(), rows, k);
  return matrix;
}

/// Multiplies `factors` (rows x k) with k pieces.
std::vector<Bytes> Multiply(Bytes* factors, std::vector<std::uint8_t*>* pieces, std::size_t size,
                            int rows) {
  const auto k = static_cast<int>(pieces->size());
  Bytes tables(factors->size() * kTableBytes);
  ec_init_tables(k, rows, factors->data(), tables.data());
  std::vector<Bytes> results(static_cast<std::size_t>(rows), Bytes(size));
  std::vector<std::uint8_t*> to;
  for (Bytes& result : results) to.push_back(result.data());
  ec_encode_data(static_cast<int>(size), k, rows, tables.data(), pieces->data(), to.data());
  return results;
}

/// ISA-L reads what it takes for data, and its signature has no const.
std::uint8_t* Readable(std::span<const std::uint8_t> bytes) {
  return const_cast<std::uint8_t*>(bytes.data());
}

/// Calculates the empty pieces of `data` from as many parity pieces: what the others have added to
/// these is taken off, and a system of as many equations as pieces are missing is left. Its matrix
/// is a part of Cauchy's, and has an inverse.
bool FillMissing(std::span<const CodedPiece> parity, std::vector<Bytes>* data) {
  const std::size_t k = data->size();
  std::vector<std::size_t> missing;
  int highest = 0;
  for (const CodedPiece& piece : parity) highest = std::max(highest, piece.row);
  for (std::size_t row = 0; row < k; ++row) {
    if ((*data)[row].empty()) missing.push_back(row);
  }
  const Bytes matrix = CodeMatrix(highest + 1, static_cast<int>(k));
  Bytes of_present, of_missing;
  std::vector<std::uint8_t*> present;
  for (Bytes& piece : *data) {
    if (!piece.empty()) present.push_back(piece.data());
  }
  for (const CodedPiece& piece : parity) {
    const std::size_t begin = static_cast<std::size_t>(piece.row) * k;
    for (std::size_t row = 0; row < k; ++row) {
      ((*data)[row].empty() ? of_missing : of_present).push_back(matrix[begin + row]);
    }
  }
  const auto number = static_cast<int>(missing.size());
  const std::size_t size = parity.front().bytes.size();
  std::vector<Bytes> rest(missing.size(), Bytes(size));
  if (!present.empty()) rest = Multiply(&of_present, &present, size, number);
  for (std::size_t i = 0; i < rest.size(); ++i) {
    std::ranges::transform(rest[i], parity[i].bytes, rest[i].begin(), std::bit_xor<>());
  }
  Bytes inverse(of_missing.size());
  if (gf_invert_matrix(of_missing.data(), inverse.data(), number) != 0) return false;
  std::vector<std::uint8_t*> from;
  for (Bytes& piece : rest) from.push_back(piece.data());
  std::vector<Bytes> found = Multiply(&inverse, &from, size, number);
  for (std::size_t i = 0; i < missing.size(); ++i) (*data)[missing[i]] = std::move(found[i]);
  return true;
}

}  // namespace

std::vector<Bytes> ParityOf(std::span<const Bytes> data, int rows) {
  if (data.empty() || rows <= 0) return {};
  const auto k = static_cast<int>(data.size());
  const Bytes matrix = CodeMatrix(k + rows, k);
  Bytes factors(matrix.begin() + std::ptrdiff_t{k} * k, matrix.end());
  std::vector<std::uint8_t*> pieces;
  for (const Bytes& piece : data) pieces.push_back(Readable(piece));
  return Multiply(&factors, &pieces, data.front().size(), rows);
}

std::vector<Bytes> RecoverData(std::span<const CodedPiece> pieces) {
  const auto k = static_cast<int>(pieces.size());
  if (k == 0 || k > kMaxCodeWord) return {};
  const std::size_t size = pieces.front().bytes.size();
  std::array<bool, kMaxCodeWord> seen{};
  std::vector<Bytes> data(pieces.size());
  std::vector<CodedPiece> parity;
  for (const CodedPiece& piece : pieces) {
    if (piece.row < 0 || piece.row >= kMaxCodeWord || piece.bytes.size() != size) return {};
    const auto row = static_cast<std::size_t>(piece.row);
    if (std::exchange(seen[row], true)) return {};
    if (piece.row < k) {
      data[row].assign(piece.bytes.begin(), piece.bytes.end());
    } else {
      parity.push_back(piece);
    }
  }
  if (parity.empty()) return data;
  if (!FillMissing(parity, &data)) return {};
  return data;
}

}  // namespace isotherm
