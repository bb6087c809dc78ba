#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <set>
#include <tuple>
#include <vector>

#include "common/messages/frame_piece.h"
#include "common/pieces/erasure_code.h"

namespace isotherm {

/// Puts frames of one sender together from its pieces, as soon as enough of them are there. A frame
/// that too little of arrives of is given up when kMaxOpen newer ones have begun, or when what is
/// kept would be more than kMaxBytes. Memory is that of the pieces that came, whatever they say.
/// Thread-compatible.
class FrameAssembler {
 public:
  static constexpr std::size_t kMaxOpen = 32;  ///< Frames. Nearly half a second of both cameras.
  static constexpr std::size_t kMaxBytes = std::size_t{32} << 20U;

  /// Returns the frame's bytes once, with the piece that completes it. Pieces that contradict the
  /// frame's others are left out.
  std::optional<Bytes> Add(FramePiece&& piece);

  std::uint64_t frames() const { return frames_; }
  /// Returns the size of the pieces of frames that are not whole.
  std::size_t kept_bytes() const { return kept_bytes_; }
  /// Returns how many frames were given up, or were others than their checksum says.
  std::uint64_t broken() const { return broken_; }

 private:
  /// Session, sensor and number of a frame.
  using Key = std::tuple<std::uint64_t, Sensor, std::uint64_t>;
  /// A frame that is not complete.
  struct Open {
    std::uint32_t frame_bytes;
    std::uint32_t frame_crc;
    std::size_t piece_bytes;
    std::vector<std::uint32_t> lacking;       ///< Pieces, by block.
    std::uint32_t incomplete = 0;             ///< Blocks that lack some.
    std::map<std::uint32_t, Bytes> pieces{};  ///< By index; no more of a block than it takes.
  };

  static Open Begin(const FramePiece& piece);
  void Keep(FramePiece&& piece, Open* open);
  static std::optional<Bytes> Join(const Open& open);
  void Close(const Key& key);
  void DropOldest();

  std::map<Key, Open> open_;
  std::deque<Key> begun_;  ///< The open ones, the oldest first.
  std::set<Key> over_;     ///< Late pieces of these are nothing new.
  std::deque<Key> over_order_;
  std::size_t kept_bytes_ = 0;
  std::uint64_t frames_ = 0;
  std::uint64_t broken_ = 0;
};

}  // namespace isotherm
