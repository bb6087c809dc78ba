#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "common/frame/frame.h"
#include "common/time/time_types.h"

/// These messages carry frames over a radio, piece by piece, and say how many of the pieces arrive.
namespace isotherm {

/// With what the middleware puts before it, a piece goes into one packet of a network.
inline constexpr std::size_t kMaxFramePieceBytes = 1'200;
inline constexpr std::size_t kMinFramePieceBytes = 256;
/// A frame that goes in pieces has no more bytes than this.
inline constexpr std::size_t kMaxPiecedFrameBytes = (std::size_t{8} << 20U) + 1'024;

/// Holds a part of a frame (`index` below the number of its data pieces), or what parts that are
/// lost can be calculated from (common/pieces/piece_layout.h).
struct FramePiece {
  std::uint64_t session = 0;
  Sensor sensor = Sensor::kDepth;
  std::uint64_t frame_number = 0;
  Nanoseconds sent{};             ///< When, on a clock of the rig that never jumps.
  std::uint64_t order = 0;        ///< Counts the pieces that a rig's process sends, from 0.
  std::uint32_t frame_bytes = 0;  ///< The whole frame's.
  std::uint32_t frame_crc = 0;    ///< CRC-32 (zlib) of the whole frame.
  std::uint32_t index = 0;
  std::vector<std::uint8_t> bytes{};  ///< All of a frame have as many.
};

/// Says how many pieces of a session have arrived, to the rig that sent them.
struct PieceReport {
  std::uint64_t session = 0;
  std::uint64_t next_order = 0;  ///< One above the highest.
  std::uint64_t received = 0;
  std::uint64_t frames = 0;  ///< Frames that could be put together.
  std::uint64_t broken = 0;  ///< Frames too little of which arrived.
  /// Since the last report some pieces one after another have taken longer than the quickest of
  /// late by this much: they have waited before a link that is too narrow.
  Nanoseconds queued{};
};

}  // namespace isotherm
