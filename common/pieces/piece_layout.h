#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "common/pieces/erasure_code.h"

namespace isotherm {

/// Says which piece of a frame is what. A frame of N bytes is cut into pieces of the same size, the
/// last filled up with zeros; they are dealt out to blocks, each of which is a code word of its
/// own, so that neighbours on the link are in different ones. Parity pieces follow, dealt out in
/// the same way. Pure.
class PieceLayout {
 public:
  /// Data pieces of a block. Larger ones need less parity for the same losses, but more time.
  static constexpr std::uint32_t kMaxBlock = 128;
  static constexpr std::uint32_t kMaxParity = kMaxCodeWord - kMaxBlock;

  PieceLayout(std::size_t frame_bytes, std::size_t piece_bytes)
      : frame_bytes_(frame_bytes),
        piece_bytes_(piece_bytes),
        pieces_(static_cast<std::uint32_t>((frame_bytes + piece_bytes - 1) / piece_bytes)),
        blocks_((pieces_ + kMaxBlock - 1) / kMaxBlock) {}

  std::size_t frame_bytes() const { return frame_bytes_; }
  std::size_t piece_bytes() const { return piece_bytes_; }
  /// Returns the number of data pieces.
  std::uint32_t pieces() const { return pieces_; }
  std::uint32_t blocks() const { return blocks_; }
  /// Returns how many data pieces a block has.
  std::uint32_t PiecesIn(std::uint32_t block) const {
    return (pieces_ - block + blocks_ - 1) / blocks_;
  }
  std::uint32_t BlockOf(std::uint32_t index) const {
    return (index < pieces_ ? index : index - pieces_) % blocks_;
  }
  /// Returns the row in the block's code word.
  std::uint32_t RowOf(std::uint32_t index) const {
    if (index < pieces_) return index / blocks_;
    return PiecesIn(BlockOf(index)) + (index - pieces_) / blocks_;
  }
  /// Returns the index of a parity piece.
  std::uint32_t ParityIndex(std::uint32_t block, std::uint32_t parity) const {
    return pieces_ + parity * blocks_ + block;
  }
  /// Returns whether there can be such a piece.
  bool Has(std::uint32_t index) const { return index < pieces_ + kMaxParity * blocks_; }

 private:
  std::size_t frame_bytes_;
  std::size_t piece_bytes_;
  std::uint32_t pieces_;
  std::uint32_t blocks_;
};

}  // namespace isotherm
