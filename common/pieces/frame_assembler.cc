#include "common/pieces/frame_assembler.h"

#include <zlib.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "common/pieces/piece_layout.h"

namespace isotherm {
namespace {

constexpr std::size_t kRemembered = 512;  ///< Frames whose late pieces are known as such.

}  // namespace

FrameAssembler::Open FrameAssembler::Begin(const FramePiece& piece) {
  const PieceLayout layout(piece.frame_bytes, piece.bytes.size());
  Open open{.frame_bytes = piece.frame_bytes,
            .frame_crc = piece.frame_crc,
            .piece_bytes = piece.bytes.size(),
            .lacking = {},
            .incomplete = layout.blocks()};
  for (std::uint32_t block = 0; block < layout.blocks(); ++block) {
    open.lacking.push_back(layout.PiecesIn(block));
  }
  return open;
}

void FrameAssembler::Keep(FramePiece&& piece, Open* open) {
  std::uint32_t& lacking =
      open->lacking[PieceLayout(open->frame_bytes, open->piece_bytes).BlockOf(piece.index)];
  if (lacking == 0) return;
  if (!open->pieces.try_emplace(piece.index, std::move(piece.bytes)).second) return;
  kept_bytes_ += open->piece_bytes;
  if (--lacking == 0) --open->incomplete;
}

std::optional<Bytes> FrameAssembler::Join(const Open& open) {
  const PieceLayout layout(open.frame_bytes, open.piece_bytes);
  std::vector<std::vector<CodedPiece>> blocks(layout.blocks());
  for (const auto& [index, bytes] : open.pieces) {
    blocks[layout.BlockOf(index)].push_back({static_cast<int>(layout.RowOf(index)), bytes});
  }
  Bytes frame(layout.pieces() * layout.piece_bytes());
  for (std::uint32_t block = 0; block < layout.blocks(); ++block) {
    const std::vector<Bytes> data = RecoverData(blocks[block]);
    if (data.size() != layout.PiecesIn(block)) return std::nullopt;
    for (std::size_t row = 0; row < data.size(); ++row) {
      const std::size_t index = row * layout.blocks() + block;
      std::ranges::copy(data[row],
                        frame.begin() + static_cast<std::ptrdiff_t>(index * layout.piece_bytes()));
    }
  }
  frame.resize(open.frame_bytes);
  const auto size = static_cast<uInt>(frame.size());
  if (crc32(0, frame.data(), size) != open.frame_crc) return std::nullopt;
  return frame;
}

std::optional<Bytes> FrameAssembler::Add(FramePiece&& piece) {
  if (piece.frame_bytes == 0 || piece.frame_bytes > kMaxPiecedFrameBytes ||
      piece.bytes.size() < kMinFramePieceBytes || piece.bytes.size() > kMaxFramePieceBytes) {
    return std::nullopt;
  }
  const Key key{piece.session, piece.sensor, piece.frame_number};
  if (over_.contains(key) || !PieceLayout(piece.frame_bytes, piece.bytes.size()).Has(piece.index)) {
    return std::nullopt;
  }
  auto found = open_.find(key);
  if (found == open_.end()) {
    found = open_.emplace(key, Begin(piece)).first;
    begun_.push_back(key);
  }
  Open& open = found->second;
  if (open.frame_bytes != piece.frame_bytes || open.frame_crc != piece.frame_crc ||
      open.piece_bytes != piece.bytes.size()) {
    return std::nullopt;
  }
  Keep(std::move(piece), &open);
  if (open.incomplete == 0) {
    std::optional<Bytes> frame = Join(open);
    ++(frame ? frames_ : broken_);
    Close(key);
    return frame;
  }
  while (open_.size() > kMaxOpen || kept_bytes_ > kMaxBytes) DropOldest();
  return std::nullopt;
}

void FrameAssembler::DropOldest() {
  ++broken_;
  Close(Key(begun_.front()));
}

void FrameAssembler::Close(const Key& key) {
  const auto found = open_.find(key);
  kept_bytes_ -= found->second.pieces.size() * found->second.piece_bytes;
  open_.erase(found);
  std::erase(begun_, key);
  over_.insert(key);
  over_order_.push_back(key);
  if (over_order_.size() <= kRemembered) return;
  over_.erase(over_order_.front());
  over_order_.pop_front();
}

}  // namespace isotherm
