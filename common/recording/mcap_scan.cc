#include "common/recording/mcap_scan.h"

#include <algorithm>
#include <optional>
#include <utility>

#include "common/recording/mcap_resync.h"

namespace isotherm::mcap {
namespace {

/// Headers, schemas, channels and metadata are small.
constexpr std::uint64_t kMaxSmallRecordBytes = 16U << 20;
/// Messages outside chunks are read in stretches of about this size.
constexpr std::uint64_t kLooseSegmentBytes = 1U << 20;
/// Two days of a recorder that writes two chunks a second, and what their message indexes count.
constexpr std::size_t kMaxSegments = 400'000;
constexpr std::size_t kMaxCounts = 1'000'000;

/// Goes through a file once, from record to record. Where no sound record follows, it looks for the
/// next place where one does and notes the gap.
class Scanner {
 public:
  explicit Scanner(const ByteSource& source) : source_(source), budget_(source.size()) {}

  FileIndex Run() {
    std::uint64_t offset = kMagic.size();
    while (offset < source_.size() && !closed_) {
      const auto record = SoundRecordAt(source_, offset);
      if (!record) {
        offset = Resynchronise(offset);
        continue;
      }
      Visit(*record);
      offset = record->end();
    }
    offset = std::min(offset + (closed_ ? kMagic.size() : 0), source_.size());
    if (offset < source_.size())
      AddGap({.offset = offset, .length = source_.size() - offset, .message_counts = {}});
    // Order matters: counting first, because it reads chunks that the check of the tail need not
    // read again.
    CountUnindexedChunks();
    // Without a footer the last chunk may be half written, with a header that looks whole.
    if (!closed_) DropDamagedTail();
    file_.definitions.Merge(std::move(loose_definitions_));
    std::sort(file_.gaps.begin(), file_.gaps.end(),
              [](const Gap& a, const Gap& b) { return a.offset < b.offset; });
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
  /// Says what the next message indexes are about.
  enum class Indexed { kNothing, kChunk, kGap };

  /// Notes the gap from `bad` to where the file goes on, and returns that place.
  std::uint64_t Resynchronise(std::uint64_t bad) {
    std::uint64_t from = bad + 1;
    while (const auto record = FindRecord(source_, from)) {
      if (record->opcode != Opcode::kChunk || IsGoodChunk(*record)) {
        AddGap({.offset = bad, .length = record->offset - bad, .message_counts = {}});
        if (record->opcode == Opcode::kMessageIndex) indexed_ = Indexed::kGap;
        return record->offset;
      }
      if (budget_.exhausted()) break;
      from = record->offset + 1;
    }
    AddGap({.offset = bad, .length = source_.size() - bad, .message_counts = {}});
    return source_.size();
  }

  void AddGap(Gap gap) {
    file_.bytes_ignored += gap.length;
    if (file_.gaps.size() < FileIndex::kMaxGaps) file_.gaps.push_back(std::move(gap));
  }

  bool IsGoodChunk(const RecordPosition& record) {
    return ReadSegment(source_, {.offset = record.offset, .length = record.length()}, budget_)
        .has_value();
  }

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
      case Opcode::kFooter:
        closed_ = true;
        return;
      default:
        indexed_ = Indexed::kNothing;  // Derived, or newer than this program.
    }
  }

  void VisitChunk(const RecordPosition& record) {
    const std::optional<ChunkHeader> header = ChunkHeaderAt(source_, record);
    if (!header || scanned_.size() == kMaxSegments) {
      indexed_ = Indexed::kNothing;
      return AddGap({.offset = record.offset, .length = record.length(), .message_counts = {}});
    }
    scanned_.push_back({.segment = {.is_chunk = true,
                                    .offset = record.offset,
                                    .length = record.length(),
                                    .start = header->start,
                                    .end = header->end},
                        .counts = {}});
    file_.compressions.insert(header->compression);
    indexed_ = Indexed::kChunk;
  }

  void VisitMessageIndex(const RecordPosition& record) {
    constexpr std::uint64_t kEntryBytes = 16;
    constexpr std::uint64_t kFieldsBytes = 2 + 4;
    std::array<std::uint8_t, sizeof(ChannelId)> id{};
    // Indexes follow their chunk; those behind a gap say what was lost in it.
    if (indexed_ == Indexed::kNothing || counts_ == kMaxCounts ||
        !source_.Read(record.offset + kRecordPrefixBytes, id).ok()) {
      return;
    }
    ++counts_;
    const auto channel = static_cast<ChannelId>(id[0] | id[1] << 8);
    auto& counts =
        indexed_ == Indexed::kChunk ? scanned_.back().counts : file_.gaps.back().message_counts;
    counts[channel] += (record.content_length - kFieldsBytes) / kEntryBytes;
  }

  void VisitMessage(const RecordPosition& record) {
    indexed_ = Indexed::kNothing;
    constexpr std::uint64_t kFieldsBytes = 2 + 4 + 8 + 8;
    Bytes fields(static_cast<std::size_t>(std::min(record.content_length, kFieldsBytes)));
    Message message;
    if (!source_.Read(record.offset + kRecordPrefixBytes, fields).ok() || !Parse(fields, message)) {
      return AddGap({.offset = record.offset, .length = record.length(), .message_counts = {}});
    }
    // Messages without chunks are joined into stretches, so that a file of millions of them has an
    // index of bounded size.
    const bool continues =
        !scanned_.empty() && !scanned_.back().segment.is_chunk &&
        scanned_.back().segment.length < kLooseSegmentBytes &&
        scanned_.back().segment.offset + scanned_.back().segment.length == record.offset;
    if (!continues) {
      if (scanned_.size() == kMaxSegments)
        return AddGap({.offset = record.offset, .length = record.length(), .message_counts = {}});
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
    const std::uint64_t room = record.opcode == Opcode::kMetadata
                                   ? kMaxMetadataBytes - metadata_bytes_
                                   : kMaxDefinitionBytes;
    // Many small definitions could add up to any size.
    if (record.content_length > room) return;
    Bytes content(static_cast<std::size_t>(record.content_length));
    if (!source_.Read(record.offset + kRecordPrefixBytes, content).ok()) return;
    loose_definitions_.Add({.opcode = record.opcode, .offset = 0, .content = content});
    Metadata metadata;
    if (record.opcode == Opcode::kMetadata && Parse(content, metadata)) {
      metadata_bytes_ += content.size();
      file_.metadata.push_back(std::move(metadata));
    }
  }

  bool IsUnknown(const Scanned& scanned) const {
    // A chunk without indexes, or with channels that nothing described yet, must be unpacked to be
    // counted.
    return scanned.counts.empty() ||
           std::any_of(scanned.counts.begin(), scanned.counts.end(), [this](const auto& count) {
             return !file_.definitions.channels.contains(count.first);
           });
  }

  /// Reads the chunk: counts its messages and learns its channels.
  bool ReadContent(Scanned& scanned) {
    Result<SegmentContent> content = ReadSegment(source_, scanned.segment, budget_);
    if (!content) return false;
    scanned.checked = true;
    scanned.counts.clear();
    for (const auto& entry : content->entries) ++scanned.counts[entry.channel_id];
    file_.definitions.Merge(std::move(content->definitions));
    return true;
  }

  void CountUnindexedChunks() {
    for (Scanned& scanned : scanned_) {
      if (scanned.segment.is_chunk && IsUnknown(scanned) && !budget_.exhausted())
        ReadContent(scanned);
    }
  }

  void DropDamagedTail() {
    while (!scanned_.empty() && !scanned_.back().checked && !ReadContent(scanned_.back())) {
      if (budget_.exhausted()) return;
      Scanned& last = scanned_.back();
      AddGap({.offset = last.segment.offset,
              .length = last.segment.length,
              .message_counts = std::move(last.counts)});
      scanned_.pop_back();
    }
  }

  const ByteSource& source_;
  UnpackBudget budget_;
  FileIndex file_;
  /// From outside the chunks, where no checksum covers them: chunks know better.
  Definitions loose_definitions_;
  std::vector<Scanned> scanned_;
  Indexed indexed_ = Indexed::kNothing;
  std::size_t counts_ = 0;
  std::uint64_t metadata_bytes_ = 0;
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
