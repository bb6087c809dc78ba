#include "common/pieces/cut_frame.h"

#include <zlib.h>

#include <algorithm>
#include <utility>

#include "common/pieces/piece_layout.h"

namespace isotherm {

std::vector<FramePiece> CutFrame(std::span<const std::uint8_t> frame, const ParityRule& parity) {
  const std::size_t number = (frame.size() + kMaxFramePieceBytes - 1) / kMaxFramePieceBytes;
  const std::size_t piece_bytes =
      std::max(kMinFramePieceBytes, (frame.size() + number - 1) / number);
  const PieceLayout layout(frame.size(), piece_bytes);
  const auto crc =
      static_cast<std::uint32_t>(crc32(0, frame.data(), static_cast<uInt>(frame.size())));
  std::vector<FramePiece> pieces;
  std::vector<std::vector<Bytes>> blocks(layout.blocks());
  for (std::uint32_t index = 0; index < layout.pieces(); ++index) {
    const std::size_t begin = index * piece_bytes;
    const auto part = frame.subspan(begin, std::min(piece_bytes, frame.size() - begin));
    Bytes bytes(part.begin(), part.end());
    bytes.resize(piece_bytes);
    blocks[layout.BlockOf(index)].push_back(bytes);
    pieces.push_back({.frame_bytes = static_cast<std::uint32_t>(frame.size()),
                      .frame_crc = crc,
                      .index = index,
                      .bytes = std::move(bytes)});
  }
  for (std::uint32_t block = 0; block < layout.blocks(); ++block) {
    const auto data = static_cast<int>(blocks[block].size());
    const int rows = std::clamp(parity(data), 0, static_cast<int>(PieceLayout::kMaxParity));
    std::uint32_t row = 0;
    for (Bytes& bytes : ParityOf(blocks[block], rows)) {
      pieces.push_back({.frame_bytes = static_cast<std::uint32_t>(frame.size()),
                        .frame_crc = crc,
                        .index = layout.ParityIndex(block, row++),
                        .bytes = std::move(bytes)});
    }
  }
  std::ranges::sort(pieces, {}, &FramePiece::index);
  return pieces;
}

}  // namespace isotherm
