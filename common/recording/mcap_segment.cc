#include "common/recording/mcap_segment.h"

#include <fmt/format.h>
#include <zstd.h>

#include <algorithm>
namespace isotherm::mcap {
namespace {

Status Damaged(const Segment& segment, std::string_view what) {
  return DataLoss(fmt::format("chunk at byte {}: {}", segment.offset, what));
}

Status CheckHeader(const Segment& segment, const ChunkHeader& header) {
  if (header.uncompressed_size > kMaxChunkBytes) {
    return Damaged(segment, fmt::format("claims {} bytes, the limit is {}",
                                        header.uncompressed_size, kMaxChunkBytes));
  }
  const std::uint64_t rest = segment.length - kRecordPrefixBytes;
  if (header.compressed_size > rest) return Damaged(segment, "claims more bytes than it has");
  if (header.compression.empty() && header.compressed_size != header.uncompressed_size) {
    return Damaged(segment, "sizes disagree");
  }
  if (!IsSupportedCompression(header.compression)) {
    return Damaged(segment, fmt::format("unknown compression \"{}\"", header.compression));
  }
  return OkStatus();
}

Status Unpack(const Segment& segment, const ChunkHeader& header,
              std::span<const std::uint8_t> packed, Bytes& records) {
  if (header.compression.empty()) {
    records.assign(packed.begin(), packed.end());
  } else {
    records.resize(static_cast<std::size_t>(header.uncompressed_size));
    const std::size_t size =
        ZSTD_decompress(records.data(), records.size(), packed.data(), packed.size());
    if (ZSTD_isError(size)) return Damaged(segment, ZSTD_getErrorName(size));
    if (size != records.size()) return Damaged(segment, "is shorter than it claims");
  }
  if (header.uncompressed_crc != 0 && Crc32(records) != header.uncompressed_crc) {
    return Damaged(segment, "checksum mismatch");
  }
  return OkStatus();
}

/// The chunk's records, unpacked; `bytes` is the whole chunk record.
Result<Bytes> UnpackChunk(const Segment& segment, const Bytes& bytes) {
  const auto [opcode, length] = ParseRecordPrefix(bytes);
  if (opcode != Opcode::kChunk || length != bytes.size() - kRecordPrefixBytes) {
    return Err(Damaged(segment, "is not where the index says"));
  }
  const auto content = std::span(bytes).subspan(kRecordPrefixBytes);
  ChunkHeader header;
  if (!Parse(content, header)) return Err(Damaged(segment, "its header is damaged"));
  if (Status status = CheckHeader(segment, header); !status.ok()) return Err(std::move(status));
  // The packed records follow the fields, whose length depends on one string only.
  const std::size_t fields_bytes = 8 + 8 + 8 + 4 + 4 + header.compression.size() + 8;
  if (header.compressed_size > content.size() - fields_bytes) {
    return Err(Damaged(segment, "claims more bytes than it has"));
  }
  const auto packed =
      content.subspan(fields_bytes, static_cast<std::size_t>(header.compressed_size));
  Bytes records;
  if (Status status = Unpack(segment, header, packed, records); !status.ok()) {
    return Err(std::move(status));
  }
  return records;
}

Status IndexRecords(const Segment& segment, SegmentContent& content) {
  RecordWalker walker(content.records);
  while (const auto record = walker.Next()) {
    content.definitions.Add(*record);
    if (record->opcode != Opcode::kMessage) continue;
    Message message;
    if (!Parse(record->content, message)) return Damaged(segment, "holds a damaged message");
    content.entries.push_back(
        {.log_time = message.log_time, .offset = record->offset, .channel_id = message.channel_id});
  }
  if (!walker.AtEnd()) return Damaged(segment, "its records are damaged");
  std::stable_sort(content.entries.begin(), content.entries.end(),
                   [](const auto& a, const auto& b) { return a.log_time < b.log_time; });
  return OkStatus();
}

}  // namespace

bool IsSupportedCompression(std::string_view compression) {
  return compression.empty() || compression == "zstd";
}

void Definitions::Add(const RecordWalker::Record& record) {
  if (record.opcode == Opcode::kSchema) {
    Schema schema;
    if (Parse(record.content, schema) && schema.id != 0) schemas.try_emplace(schema.id, schema);
  } else if (record.opcode == Opcode::kChannel) {
    Channel channel;
    if (Parse(record.content, channel)) channels.try_emplace(channel.id, channel);
  }
}

Result<SegmentContent> ReadSegment(const ByteSource& source, const Segment& segment) {
  // Compression never grows a chunk by more than a small fraction.
  if (segment.length > kMaxChunkBytes + kMaxChunkBytes / 64 ||
      segment.length < kRecordPrefixBytes || segment.offset > source.size() ||
      segment.length > source.size() - segment.offset) {
    return Err(
        Damaged(segment, fmt::format("its length of {} bytes is impossible", segment.length)));
  }
  Bytes bytes(static_cast<std::size_t>(segment.length));
  if (Status status = source.Read(segment.offset, bytes); !status.ok())
    return Err(std::move(status));
  SegmentContent content;
  if (segment.is_chunk) {
    Result<Bytes> records = UnpackChunk(segment, bytes);
    if (!records) return Err(std::move(records.error()));
    content.records = std::move(*records);
  } else {
    content.records = std::move(bytes);
  }
  if (Status status = IndexRecords(segment, content); !status.ok()) return Err(std::move(status));
  return content;
}

std::optional<Message> MessageAt(const SegmentContent& content,
                                 const SegmentContent::Entry& entry) {
  if (entry.offset > content.records.size()) return std::nullopt;
  RecordWalker walker(std::span(content.records).subspan(entry.offset));
  const auto record = walker.Next();
  Message message;
  if (!record || !Parse(record->content, message)) return std::nullopt;
  return message;
}

}  // namespace isotherm::mcap
