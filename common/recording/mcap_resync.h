#pragma once

#include <optional>

#include "common/recording/byte_stream.h"
#include "common/recording/mcap_records.h"

namespace isotherm::mcap {

/// One record as seen from outside.
struct RecordPosition {
  Opcode opcode{};
  std::uint64_t offset = 0;
  std::uint64_t content_length = 0;

  std::uint64_t length() const { return kRecordPrefixBytes + content_length; }
  std::uint64_t end() const { return offset + length(); }
};

/// nullopt if no whole record starts at `offset`.
std::optional<RecordPosition> RecordAt(const ByteSource& source, std::uint64_t offset);

/// The record at `offset` if its length can be believed: one bit that flips in it would otherwise
/// make the reader jump over any part of the file. A record is sound if its content fills it
/// exactly or, where that cannot be told, if another record follows it.
std::optional<RecordPosition> SoundRecordAt(const ByteSource& source, std::uint64_t offset);

/// The next place at or after `from` where reading can go on: a chunk, a message index or the end
/// of the data, whose fields agree with its length. Other records are too little apart from noise.
/// A chunk's checksum is for the caller to check.
std::optional<RecordPosition> FindRecord(const ByteSource& source, std::uint64_t from);

/// The fields of a chunk record; nullopt if they cannot be read.
std::optional<ChunkHeader> ChunkHeaderAt(const ByteSource& source, const RecordPosition& record);

}  // namespace isotherm::mcap
