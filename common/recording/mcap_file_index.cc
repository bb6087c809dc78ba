#include "common/recording/mcap_file_index.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "common/recording/mcap_scan.h"

namespace isotherm::mcap {
namespace {

/// Two hours of recording have a summary of about 3 MB.
constexpr std::uint64_t kMaxSummaryBytes = 32U << 20;

Status CheckMagic(const ByteSource& source) {
  std::array<std::uint8_t, kMagic.size()> magic{};
  if (source.size() < magic.size()) {
    return DataLoss(fmt::format("not an MCAP file: it has only {} bytes", source.size()));
  }
  ISOTHERM_RETURN_IF_ERROR(source.Read(0, magic));
  if (magic == kMagic) return OkStatus();
  constexpr std::size_t kVersionPosition = 5;
  const char version = static_cast<char>(magic[kVersionPosition]);
  // Without the version, everything else must fit.
  magic[kVersionPosition] = kMagic[kVersionPosition];
  if (magic != kMagic) return DataLoss("not an MCAP file: it starts with other bytes");
  return FailedPrecondition(fmt::format(
      "MCAP version '{}' is newer than this program, which reads version '0': update Isotherm",
      version));
}

/// Offset of the footer record if the file ends with one.
std::optional<Footer> ReadFooter(const ByteSource& source) {
  constexpr std::size_t kEndBytes = kFooterRecordBytes + kMagic.size();
  if (source.size() < kMagic.size() + kEndBytes) return std::nullopt;
  std::array<std::uint8_t, kEndBytes> end{};
  if (!source.Read(source.size() - kEndBytes, end).ok()) return std::nullopt;
  if (!std::equal(kMagic.begin(), kMagic.end(), end.end() - kMagic.size())) return std::nullopt;
  const auto [opcode, length] = ParseRecordPrefix(end);
  Footer footer;
  if (opcode != Opcode::kFooter || length != kFooterRecordBytes - kRecordPrefixBytes ||
      !Parse(std::span(end).subspan(kRecordPrefixBytes), footer)) {
    return std::nullopt;
  }
  return footer;
}

/// The summary with its footer; empty if there is none or its checksum is wrong.
Bytes ReadSummaryBytes(const ByteSource& source) {
  const std::optional<Footer> footer = ReadFooter(source);
  const std::uint64_t end = source.size() - kMagic.size();
  if (!footer || footer->summary_start < kMagic.size() || footer->summary_start >= end ||
      end - footer->summary_start > kMaxSummaryBytes) {
    return {};
  }
  Bytes bytes(static_cast<std::size_t>(end - footer->summary_start));
  if (bytes.size() < kFooterRecordBytes || !source.Read(footer->summary_start, bytes).ok())
    return {};
  const auto checked = std::span(bytes).first(bytes.size() - sizeof(footer->summary_crc));
  if (footer->summary_crc != 0 && Crc32(checked) != footer->summary_crc) return {};
  return bytes;
}

struct Summary {
  FileIndex file;
  std::optional<Statistics> statistics;
  /// Read so far: an index may list the same record many times.
  std::uint64_t metadata_bytes = 0;
};

bool AddMetadata(const ByteSource& source, const MetadataIndex& index, Summary& summary) {
  if (index.length < kRecordPrefixBytes ||
      index.length > kMaxMetadataBytes - summary.metadata_bytes || index.offset > source.size() ||
      index.length > source.size() - index.offset) {
    return false;
  }
  summary.metadata_bytes += index.length;
  Bytes bytes(static_cast<std::size_t>(index.length));
  if (!source.Read(index.offset, bytes).ok()) return false;
  RecordWalker walker(bytes);
  const auto record = walker.Next();
  Metadata metadata;
  if (!record || record->opcode != Opcode::kMetadata || !Parse(record->content, metadata))
    return false;
  summary.file.metadata.push_back(std::move(metadata));
  return true;
}

bool AddSummaryRecord(const ByteSource& source, const RecordWalker::Record& record,
                      Summary& summary) {
  FileIndex& file = summary.file;
  switch (record.opcode) {
    case Opcode::kChunkIndex: {
      ChunkIndex chunk;
      if (!Parse(record.content, chunk)) return false;
      file.segments.push_back({.is_chunk = true,
                               .offset = chunk.chunk_offset,
                               .length = chunk.chunk_length,
                               .start = chunk.start,
                               .end = chunk.end});
      file.compressions.insert(chunk.compression);
      // Written so that the sum cannot overflow.
      return chunk.chunk_offset <= source.size() &&
             chunk.chunk_length <= source.size() - chunk.chunk_offset;
    }
    case Opcode::kStatistics:
      return Parse(record.content, summary.statistics.emplace());
    case Opcode::kMetadataIndex: {
      MetadataIndex index;
      return Parse(record.content, index) && AddMetadata(source, index, summary);
    }
    default:
      file.definitions.Add(record);
      return true;
  }
}

/// True if the summary lists everything that the statistics count.
bool CoversEverything(const FileIndex& file, const Statistics& statistics) {
  return statistics.chunk_count == file.segments.size() &&
         statistics.metadata_count == file.metadata.size() &&
         statistics.channel_count <= file.definitions.channels.size() &&
         statistics.schema_count <= file.definitions.schemas.size() &&
         (statistics.message_count == 0 || statistics.chunk_count > 0);
}

std::optional<FileIndex> ReadSummary(const ByteSource& source) {
  const Bytes bytes = ReadSummaryBytes(source);
  if (bytes.empty()) return std::nullopt;
  Summary summary;
  RecordWalker walker(bytes);
  while (const auto record = walker.Next()) {
    if (!AddSummaryRecord(source, *record, summary)) return std::nullopt;
  }
  auto& [file, statistics, metadata_bytes] = summary;
  file.complete = true;
  // A summary that is only almost right would hide messages: then the file is scanned.
  if (!walker.AtEnd() || !statistics || !CoversEverything(file, *statistics)) return std::nullopt;
  file.message_counts = std::move(statistics->channel_message_counts);
  std::sort(file.segments.begin(), file.segments.end(),
            [](const Segment& a, const Segment& b) { return a.offset < b.offset; });
  return std::move(file);
}

}  // namespace

Result<FileIndex> ReadFileIndex(const ByteSource& source) {
  if (Status status = CheckMagic(source); !status.ok()) return Err(std::move(status));
  Result<Header> header = ReadHeader(source);
  std::optional<FileIndex> file = ReadSummary(source);
  if (!file) file = ScanFile(source);
  // The header says nothing that is needed, so damage in it costs nothing.
  if (!header && file->segments.empty()) return Err(std::move(header.error()));
  if (header) file->header = std::move(*header);
  const auto supported = [](const std::string& name) { return IsSupportedCompression(name); };
  const auto& compressions = file->compressions;
  // One name that is unknown among others that are known is damage.
  if (!compressions.empty() && std::none_of(compressions.begin(), compressions.end(), supported)) {
    return Err(FailedPrecondition(
        fmt::format("compression \"{}\" is not supported: write the file with zstd or none",
                    *compressions.begin())));
  }
  return std::move(*file);
}

}  // namespace isotherm::mcap
