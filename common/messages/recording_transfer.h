#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "common/time/time_types.h"

/// These messages bring recordings from a rig to whoever asks, over the link.
namespace isotherm {

/// A piece of a recording has no more bytes than this.
inline constexpr std::size_t kMaxPieceBytes = 65'536;
/// A checksum is over no more than this: a rig is not kept busy by one request.
inline constexpr std::uint32_t kMaxChecksumBytes = 4U << 20;

/// Says what is asked for.
enum class RecordingRequestKind : std::uint8_t {
  kList,      ///< One entry of the list of recordings, by its place; the newest is the first.
  kRead,      ///< Bytes of a recording.
  kChecksum,  ///< The checksum of bytes of a recording.
  kKept,      ///< None: whoever asks has the whole recording, of `offset` bytes, on a disk.
};

/// Asks a rig for a recording, or for what there is.
struct RecordingRequest {
  std::uint64_t asker = 0;   ///< Any number that no other one uses; answers repeat it.
  std::uint64_t number = 0;  ///< The request's; its answer repeats it.
  RecordingRequestKind kind = RecordingRequestKind::kList;
  std::string recording{};   ///< A name as the list has it.
  std::uint64_t offset = 0;  ///< Byte; in the list: place.
  std::uint32_t length = 0;  ///< Bytes.
};

/// Says what became of a request.
enum class RecordingOutcome : std::uint8_t {
  kDone,
  kNotThere,      ///< No such recording, or the end of the list.
  kBeingWritten,  ///< It grows; only the list tells of it.
  kUnreadable,    ///< The disk failed, or what is asked for lies beyond the end.
  kBusy,          ///< A scan has the link for itself, or a recording is being completed.
};

/// Answers a RecordingRequest.
struct RecordingPiece {
  std::uint64_t asker = 0;
  std::uint64_t number = 0;
  RecordingOutcome outcome = RecordingOutcome::kDone;
  std::string recording{};
  std::uint64_t size = 0;  ///< The whole recording's, bytes.
  CaptureTime written{};   ///< When it was written last.
  std::uint64_t offset = 0;
  std::vector<std::uint8_t> bytes{};  ///< A read's; otherwise empty.
  std::uint32_t crc = 0;              ///< CRC-32 (zlib) of what was asked for.
};

}  // namespace isotherm
