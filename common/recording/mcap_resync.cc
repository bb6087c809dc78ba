#include "common/recording/mcap_resync.h"

#include <algorithm>
#include <array>

#include "common/recording/mcap_segment.h"

namespace isotherm::mcap {
namespace {

/// Chunk fields with the longest plausible name of a compression.
constexpr std::uint64_t kChunkFieldsBytes = 8 + 8 + 8 + 4 + 4 + 32 + 8;
/// So much of a record's start must be there to assess it.
constexpr std::size_t kHeadBytes = kRecordPrefixBytes + kChunkFieldsBytes;
constexpr std::uint64_t kIndexFieldsBytes = 2 + 4;
constexpr std::uint64_t kIndexEntryBytes = 16;

bool IsChunkOfLength(std::span<const std::uint8_t> fields, std::uint64_t length) {
  ChunkHeader header;
  return Parse(fields, header) && header.start <= header.end && header.compressed_size <= length &&
         ChunkContentBytes(header) == length;
}

bool IsMessageIndexOfLength(std::span<const std::uint8_t> fields, std::uint64_t length) {
  if (fields.size() < kIndexFieldsBytes || length < kIndexFieldsBytes) return false;
  std::uint64_t bytes = 0;
  for (std::size_t i = 0; i < 4; ++i) bytes |= std::uint64_t{fields[2 + i]} << (8 * i);
  return bytes % kIndexEntryBytes == 0 && kIndexFieldsBytes + bytes == length;
}

constexpr std::uint64_t kFooterContentBytes = kFooterRecordBytes - kRecordPrefixBytes;
constexpr std::uint64_t kDataEndBytes = 4;

/// The record that `head` starts with, if it lies in the file. `head` is cut at its end.
std::optional<RecordPosition> RecordIn(std::span<const std::uint8_t> head, std::uint64_t offset,
                                       std::uint64_t file_bytes) {
  if (head.size() < kRecordPrefixBytes) return std::nullopt;
  const auto [opcode, length] = ParseRecordPrefix(head);
  constexpr auto kNoOpcode =
      Opcode{0};  // What a file that was never written to the end is full of.
  if (opcode == kNoOpcode || length > file_bytes - offset - kRecordPrefixBytes) return std::nullopt;
  return RecordPosition{.opcode = opcode, .offset = offset, .content_length = length};
}

Bytes ReadHead(const ByteSource& source, std::uint64_t offset) {
  if (offset >= source.size()) return {};
  Bytes head(static_cast<std::size_t>(std::min<std::uint64_t>(kHeadBytes, source.size() - offset)));
  if (!source.Read(offset, head).ok()) return {};
  return head;
}

std::span<const std::uint8_t> ContentIn(std::span<const std::uint8_t> head,
                                        const RecordPosition& record) {
  const auto rest = head.subspan(kRecordPrefixBytes);
  return rest.first(
      static_cast<std::size_t>(std::min<std::uint64_t>(rest.size(), record.content_length)));
}

template <typename Record>
bool FillsExactly(const ByteSource& source, const RecordPosition& position, std::uint64_t limit) {
  if (position.content_length > limit) return false;
  Bytes content(static_cast<std::size_t>(position.content_length));
  if (!source.Read(position.offset + kRecordPrefixBytes, content).ok()) return false;
  Record record;
  if (!Parse(content, record)) return false;
  Bytes again;
  Append(record, again);  // As long as what was read, or there was more than its fields.
  return again.size() == position.length();
}

/// True if a record that lies in the file can start at `offset`, or if the file ends there.
bool SomethingFollows(const ByteSource& source, std::uint64_t offset) {
  return offset >= source.size() || RecordAt(source, offset).has_value();
}

}  // namespace

std::optional<RecordPosition> RecordAt(const ByteSource& source, std::uint64_t offset) {
  return RecordIn(ReadHead(source, offset), offset, source.size());
}

std::optional<RecordPosition> SoundRecordAt(const ByteSource& source, std::uint64_t offset) {
  const Bytes head = ReadHead(source, offset);
  const auto record = RecordIn(head, offset, source.size());
  if (!record) return std::nullopt;
  const auto content = ContentIn(head, *record);
  // A length that is off by a bit would lead into the middle of other records; each kind has
  // something to check it by.
  bool sound = false;
  switch (record->opcode) {
    case Opcode::kChunk:
      sound = IsChunkOfLength(content, record->content_length);
      break;
    case Opcode::kMessageIndex:
      sound = IsMessageIndexOfLength(content, record->content_length);
      break;
    case Opcode::kFooter:
      sound = record->content_length == kFooterContentBytes;
      break;
    case Opcode::kDataEnd:
      sound = record->content_length == kDataEndBytes;
      break;
    case Opcode::kHeader:
      sound = FillsExactly<Header>(source, *record, kMaxDefinitionBytes);
      break;
    case Opcode::kSchema:
      sound = FillsExactly<Schema>(source, *record, kMaxDefinitionBytes);
      break;
    case Opcode::kChannel:
      sound = FillsExactly<Channel>(source, *record, kMaxDefinitionBytes);
      break;
    case Opcode::kMetadata:
      sound = FillsExactly<Metadata>(source, *record, kMaxMetadataBytes);
      break;
    default:
      sound = SomethingFollows(source, record->end());
  }
  return sound ? record : std::nullopt;
}

std::optional<RecordPosition> FindRecord(const ByteSource& source, std::uint64_t from) {
  // Small at first: what looks like a record every few bytes must not cost a large read each.
  constexpr std::size_t kMaxBlockBytes = 1U << 20;
  std::size_t block_bytes = 4096;
  Bytes block;
  for (std::uint64_t at = from; at < source.size();
       at += block_bytes, block_bytes = std::min(2 * block_bytes, kMaxBlockBytes)) {
    // The heads that begin in this block may end in the next.
    block.resize(static_cast<std::size_t>(
        std::min<std::uint64_t>(block_bytes + kHeadBytes, source.size() - at)));
    if (!source.Read(at, block).ok()) return std::nullopt;
    for (std::size_t i = 0; i < std::min(block_bytes, block.size()); ++i) {
      const auto opcode = static_cast<Opcode>(block[i]);
      // Only records whose length can be checked against their fields: any byte is some opcode.
      if (opcode != Opcode::kChunk && opcode != Opcode::kMessageIndex &&
          opcode != Opcode::kDataEnd) {
        continue;
      }
      const auto head = std::span<const std::uint8_t>(block).subspan(i);
      const auto record = RecordIn(head, at + i, source.size());
      if (!record) continue;
      const auto content = ContentIn(head.first(std::min(head.size(), kHeadBytes)), *record);
      const bool sound = opcode == Opcode::kChunk ? IsChunkOfLength(content, record->content_length)
                         : opcode == Opcode::kMessageIndex
                             ? record->content_length > kIndexFieldsBytes &&
                                   IsMessageIndexOfLength(content, record->content_length)
                             : record->content_length == kDataEndBytes;
      if (sound) return record;
    }
  }
  return std::nullopt;
}

std::optional<ChunkHeader> ChunkHeaderAt(const ByteSource& source, const RecordPosition& record) {
  const Bytes head = ReadHead(source, record.offset);
  ChunkHeader header;
  if (head.size() < kRecordPrefixBytes || !Parse(ContentIn(head, record), header))
    return std::nullopt;
  return header;
}

}  // namespace isotherm::mcap
