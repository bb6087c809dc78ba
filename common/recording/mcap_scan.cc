#include "common/recording/mcap_scan.h"

#include <algorithm>
#include <optional>
#include <utility>

namespace isotherm::mcap {
namespace {

/// Headers, schemas, channels and metadata are small.
constexpr std::uint64_t kMaxSmallRecordBytes = 16U << 20;
/// Messages outside chunks are read in stretches of about this size.
constexpr std::uint64_t kLooseSegmentBytes = 1U << 20;
/// Chunk fields with the longest plausible name of a compression.
constexpr std::uint64_t kChunkFieldsBytes = 8 + 8 + 8 + 4 + 4 + 32 + 8;

/// One record as seen from outside.
struct RecordPosition {
  Opcode opcode{};
  std::uint64_t offset = 0;
  std::uint64_t content_length = 0;

  std::uint64_t length() const { return kRecordPrefixBytes + content_length; }
  std::uint64_t end() const { return offset + length(); }
};

/// nullopt if no whole record starts at `offset`.
std::optional<RecordPosition> RecordAt(const ByteSource& source, std::uint64_t offset) {
  if (source.size() - offset < kRecordPrefixBytes) return std::nullopt;
  std::array<std::uint8_t, kRecordPrefixBytes> prefix{};
  if (!source.Read(offset, prefix).ok()) return std::nullopt;
  const auto [opcode, length] = ParseRecordPrefix(prefix);
  constexpr auto kNoOpcode =
      Opcode{0};  // What a file that was never written to the end is full of.
  if (opcode == kNoOpcode || length > source.size() - offset - kRecordPrefixBytes)
    return std::nullopt;
  return RecordPosition{.opcode = opcode, .offset = offset, .content_length = length};
}

class Scanner {
 public:
  explicit Scanner(const ByteSource& source) : source_(source) {}

  FileIndex Run() {
    std::uint64_t offset = kMagic.size();
    while (const auto record = RecordAt(source_, offset)) {
      Visit(*record);
      offset = record->end();
      if (record->opcode == Opcode::kFooter) {
        closed_ = true;
        offset = std::min(offset + kMagic.size(), source_.size());
        break;
      }
    }
    file_.bytes_ignored += source_.size() - offset;
    CountUnindexedChunks();
    if (!closed_) DropDamagedTail();
    for (const Scanned& scanned : scanned_) {
      file_.segments.push_back(scanned.segment);
      for (const auto& [channel, count] : scanned.counts) file_.message_counts[channel] += count;
    }
    return std::move(file_);
  }

 private:
  struct Scanned {
    Segment segment;
    std::map<ChannelId, std::uint64_t> counts;
    bool checked = false;  ///< Its content was read and is good.
  };

  void Visit(const RecordPosition& record) {
    switch (record.opcode) {
      case Opcode::kChunk:
        return VisitChunk(record);
      case Opcode::kMessageIndex:
        return VisitMessageIndex(record);
      case Opcode::kMessage:
        return VisitMessage(record);
      case Opcode::kSchema:
      case Opcode::kChannel:
      case Opcode::kMetadata:
        return VisitSmall(record);
      default:
        return;  // Derived, or newer than this program.
    }
  }

  void VisitChunk(const RecordPosition& record) {
    Bytes fields(static_cast<std::size_t>(std::min(record.content_length, kChunkFieldsBytes)));
    ChunkHeader header;
    if (!source_.Read(record.offset + kRecordPrefixBytes, fields).ok() || !Parse(fields, header)) {
      file_.bytes_ignored += record.length();
      return;
    }
    scanned_.push_back({.segment = {.is_chunk = true,
                                    .offset = record.offset,
                                    .length = record.length(),
                                    .start = header.start,
                                    .end = header.end},
                        .counts = {}});
    file_.compressions.insert(header.compression);
  }

  void VisitMessageIndex(const RecordPosition& record) {
    constexpr std::uint64_t kEntryBytes = 16;
    constexpr std::uint64_t kFieldsBytes = 2 + 4;
    std::array<std::uint8_t, sizeof(ChannelId)> id{};
    if (scanned_.empty() || !scanned_.back().segment.is_chunk ||
        record.content_length < kFieldsBytes ||
        !source_.Read(record.offset + kRecordPrefixBytes, id).ok()) {
      return;
    }
    const auto channel = static_cast<ChannelId>(id[0] | id[1] << 8);
    scanned_.back().counts[channel] += (record.content_length - kFieldsBytes) / kEntryBytes;
  }

  void VisitMessage(const RecordPosition& record) {
    constexpr std::uint64_t kFieldsBytes = 2 + 4 + 8 + 8;
    Bytes fields(static_cast<std::size_t>(std::min(record.content_length, kFieldsBytes)));
    Message message;
    if (!source_.Read(record.offset + kRecordPrefixBytes, fields).ok() || !Parse(fields, message)) {
      file_.bytes_ignored += record.length();
      return;
    }
    const bool continues =
        !scanned_.empty() && !scanned_.back().segment.is_chunk &&
        scanned_.back().segment.length < kLooseSegmentBytes &&
        scanned_.back().segment.offset + scanned_.back().segment.length == record.offset;
    if (!continues) {
      scanned_.push_back({.segment = {.is_chunk = false,
                                      .offset = record.offset,
                                      .length = 0,
                                      .start = message.log_time,
                                      .end = message.log_time},
                          .counts = {},
                          .checked = true});
    }
    Segment& segment = scanned_.back().segment;
    segment.length += record.length();
    segment.start = std::min(segment.start, message.log_time);
    segment.end = std::max(segment.end, message.log_time);
    ++scanned_.back().counts[message.channel_id];
  }

  void VisitSmall(const RecordPosition& record) {
    if (record.content_length > kMaxSmallRecordBytes) return;
    Bytes content(static_cast<std::size_t>(record.content_length));
    if (!source_.Read(record.offset + kRecordPrefixBytes, content).ok()) return;
    file_.definitions.Add({.opcode = record.opcode, .offset = 0, .content = content});
    Metadata metadata;
    if (record.opcode == Opcode::kMetadata && Parse(content, metadata)) {
      file_.metadata.push_back(std::move(metadata));
    }
  }

  bool IsUnknown(const Scanned& scanned) const {
    return scanned.counts.empty() ||
           std::any_of(scanned.counts.begin(), scanned.counts.end(), [this](const auto& count) {
             return !file_.definitions.channels.contains(count.first);
           });
  }

  /// Reads the chunk: counts its messages and learns its channels.
  bool ReadContent(Scanned& scanned) {
    Result<SegmentContent> content = ReadSegment(source_, scanned.segment);
    if (!content) return false;
    scanned.checked = true;
    scanned.counts.clear();
    for (const auto& entry : content->entries) ++scanned.counts[entry.channel_id];
    file_.definitions.schemas.merge(content->definitions.schemas);
    file_.definitions.channels.merge(content->definitions.channels);
    return true;
  }

  void CountUnindexedChunks() {
    for (Scanned& scanned : scanned_) {
      if (scanned.segment.is_chunk && IsUnknown(scanned)) ReadContent(scanned);
    }
  }

  void DropDamagedTail() {
    while (!scanned_.empty() && !scanned_.back().checked && !ReadContent(scanned_.back())) {
      file_.bytes_ignored += scanned_.back().segment.length;
      scanned_.pop_back();
    }
  }

  const ByteSource& source_;
  FileIndex file_;
  std::vector<Scanned> scanned_;
  bool closed_ = false;
};

}  // namespace

Result<Header> ReadHeader(const ByteSource& source) {
  const auto record = RecordAt(source, kMagic.size());
  if (!record || record->opcode != Opcode::kHeader ||
      record->content_length > kMaxSmallRecordBytes) {
    return Err(DataLoss("not a whole MCAP file: the header is missing"));
  }
  Bytes content(static_cast<std::size_t>(record->content_length));
  if (Status status = source.Read(record->offset + kRecordPrefixBytes, content); !status.ok()) {
    return Err(std::move(status));
  }
  Header header;
  if (!Parse(content, header)) return Err(DataLoss("not a whole MCAP file: the header is damaged"));
  return header;
}

FileIndex ScanFile(const ByteSource& source) { return Scanner(source).Run(); }

}  // namespace isotherm::mcap
