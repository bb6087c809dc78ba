#include "common/recording/mcap_repair.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <utility>

#include "common/recording/mcap_file_index.h"
#include "common/recording/mcap_resync.h"
#include "common/recording/mcap_summary.h"

namespace isotherm::mcap {
namespace {

/// Goes through the records of a file and lists what its summary tells.
class Lister {
 public:
  explicit Lister(const ByteSource& source) : source_(source) {}

  /// Lists all up to `last`, the file's last good chunk. What follows that is not whole, or stands
  /// in tail().
  Status ListUpTo(const Segment& last) {
    std::uint64_t offset = kMagic.size();
    while (offset <= last.offset) {
      const std::optional<RecordPosition> record = SoundRecordAt(source_, offset);
      if (!record || (offset == last.offset) != (record->end() == last.offset + last.length)) break;
      ISOTHERM_RETURN_IF_ERROR(Add(*record));
      offset = record->end();
      if (offset == last.offset + last.length) return ListBehind(last);
    }
    return FailedPrecondition(
        fmt::format("it is damaged in the middle, at byte {}; copy what is good of it into another "
                    "file (isotherm merge-recordings FILE -o WHOLE.mcap)",
                    offset));
  }

  SummaryContent& content() { return content_; }
  /// Records that belong behind the last chunk: its message indexes, and metadata.
  const Bytes& tail() const { return tail_; }
  /// Bytes of the file that were not whole.
  std::uint64_t cut() const { return cut_; }

 private:
  Status Add(const RecordPosition& record) {
    switch (record.opcode) {
      case Opcode::kChunk:
        return AddChunk(record);
      case Opcode::kMessageIndex:
        return AddMessageIndex(record);
      case Opcode::kMetadata:
        return AddMetadata(record, record.offset);
      case Opcode::kMessage:
      case Opcode::kAttachment:
        return FailedPrecondition("it has records that Isotherm does not write");
      default:
        return OkStatus();  // Definitions are in the chunks, too.
    }
  }

  Status AddChunk(const RecordPosition& record) {
    const std::optional<ChunkHeader> header = ChunkHeaderAt(source_, record);
    if (!header) return DataLoss(fmt::format("the chunk at byte {} is damaged", record.offset));
    content_.chunk_indexes.push_back({.start = header->start,
                                      .end = header->end,
                                      .chunk_offset = record.offset,
                                      .chunk_length = record.length(),
                                      .message_index_offsets = {},
                                      .message_index_length = 0,
                                      .compression = header->compression,
                                      .compressed_size = header->compressed_size,
                                      .uncompressed_size = header->uncompressed_size});
    return OkStatus();
  }

  Status AddMessageIndex(const RecordPosition& record) {
    if (content_.chunk_indexes.empty()) return OkStatus();
    std::array<std::uint8_t, sizeof(ChannelId)> id{};
    ISOTHERM_RETURN_IF_ERROR(source_.Read(record.offset + kRecordPrefixBytes, id));
    ChunkIndex& chunk = content_.chunk_indexes.back();
    chunk.message_index_offsets[static_cast<ChannelId>(id[0] | id[1] << 8)] = record.offset;
    chunk.message_index_length += record.length();
    return OkStatus();
  }

  /// `offset`: where it stands, or will.
  Status AddMetadata(const RecordPosition& record, std::uint64_t offset) {
    Bytes bytes(static_cast<std::size_t>(record.content_length));
    ISOTHERM_RETURN_IF_ERROR(source_.Read(record.offset + kRecordPrefixBytes, bytes));
    Metadata metadata;
    if (!Parse(bytes, metadata))
      return DataLoss(fmt::format("the metadata at byte {} is damaged", record.offset));
    content_.metadata_indexes.push_back(
        {.offset = offset, .length = record.length(), .name = std::move(metadata.name)});
    return OkStatus();
  }

  /// The indexes of the last chunk may not be whole: they are made anew.
  Status ListBehind(const Segment& last) {
    UnpackBudget budget(source_.size());
    const Result<SegmentContent> chunk = ReadSegment(source_, last, budget);
    if (!chunk) return chunk.error();
    std::map<ChannelId, MessageIndex> indexes;
    for (const SegmentContent::Entry& entry : chunk->entries) {
      MessageIndex& index = indexes[entry.channel_id];
      index.channel_id = entry.channel_id;
      index.entries.emplace_back(entry.log_time, entry.offset);
    }
    const std::uint64_t end = last.offset + last.length;
    ChunkIndex& listed = content_.chunk_indexes.back();
    for (const auto& [channel, index] : indexes) {
      listed.message_index_offsets[channel] = end + tail_.size();
      Append(index, tail_);
    }
    listed.message_index_length = tail_.size();
    std::uint64_t offset = end;
    while (const std::optional<RecordPosition> record = SoundRecordAt(source_, offset)) {
      if (record->opcode == Opcode::kMetadata) {
        const std::size_t begin = tail_.size();
        ISOTHERM_RETURN_IF_ERROR(AddMetadata(*record, end + begin));
        tail_.resize(begin + static_cast<std::size_t>(record->length()));
        ISOTHERM_RETURN_IF_ERROR(source_.Read(record->offset, std::span(tail_).subspan(begin)));
      } else if (record->opcode != Opcode::kMessageIndex) {
        ISOTHERM_RETURN_IF_ERROR(CheckCut(*record));
        break;
      }
      offset = record->end();
    }
    cut_ = source_.size() - offset;
    return OkStatus();
  }

  /// Refuses to cut off what this program cannot read: only what is not whole, and a summary.
  Status CheckCut(const RecordPosition& record) const {
    bool is_unknown = record.opcode == Opcode::kMessage || record.opcode == Opcode::kAttachment;
    if (record.opcode == Opcode::kChunk) {
      const std::optional<ChunkHeader> header = ChunkHeaderAt(source_, record);
      is_unknown = header && (header->uncompressed_size > kMaxChunkBytes ||
                              !IsSupportedCompression(header->compression));
    }
    if (!is_unknown) return OkStatus();
    return FailedPrecondition("its last part is none that Isotherm writes, and would be lost");
  }

  const ByteSource& source_;
  SummaryContent content_;
  Bytes tail_;
  std::uint64_t cut_ = 0;
};

/// Completes what the summary tells by what the scan of the file has found.
void Describe(const FileIndex& file, SummaryContent& content) {
  for (const auto& [id, schema] : file.definitions.schemas) content.schemas.push_back(schema);
  for (const auto& [id, channel] : file.definitions.channels) content.channels.push_back(channel);
  Statistics& statistics = content.statistics;
  statistics.metadata_count = static_cast<std::uint32_t>(content.metadata_indexes.size());
  statistics.chunk_count = static_cast<std::uint32_t>(content.chunk_indexes.size());
  statistics.channel_message_counts = file.message_counts;
  for (const auto& [channel, count] : file.message_counts) statistics.message_count += count;
  statistics.start = file.segments.front().start;
  for (const Segment& segment : file.segments) {
    statistics.start = std::min(statistics.start, segment.start);
    statistics.end = std::max(statistics.end, segment.end);
  }
}

}  // namespace

Result<std::optional<std::uint64_t>> CompleteFile(const std::filesystem::path& path) {
  const auto fail = [&path](const Status& status) {
    return Err(Status(status.code(),
                      fmt::format("{} cannot be completed: {}", path.string(), status.message())));
  };
  // Locked before it is read: a writer that ends meanwhile would be cut off.
  const Result<std::unique_ptr<FileEnd>> file_end = LockFileEnd(path);
  if (!file_end) return fail(file_end.error());
  const Result<std::unique_ptr<ByteSource>> source = OpenFileSource(path);
  if (!source) return fail(source.error());
  const Result<FileIndex> file = ReadFileIndex(**source);
  if (!file) return fail(file.error());
  if (file->complete) return std::optional<std::uint64_t>();
  if (file->segments.empty()) return fail(FailedPrecondition("nothing in it is whole"));
  const Segment& last = file->segments.back();
  Lister lister(**source);
  if (const Status listed = lister.ListUpTo(last); !listed.ok()) return fail(listed);
  Describe(*file, lister.content());
  Bytes end = lister.tail();
  Append(DataEnd{.data_section_crc = 0}, end);
  const std::uint64_t data_end = last.offset + last.length;
  AppendSummary(lister.content(), data_end, end);
  const Status replaced = (*file_end)->Replace(data_end, end);
  if (!replaced.ok()) return fail(replaced);
  return std::optional(lister.cut());
}

}  // namespace isotherm::mcap
