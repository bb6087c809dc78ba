#include "common/recording/mcap_segment.h"

#include <fmt/format.h>
#include <zstd.h>

#include <algorithm>
#include <utility>

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
Result<Bytes> UnpackChunk(const Segment& segment, const Bytes& bytes, UnpackBudget& budget) {
  const auto [opcode, length] = ParseRecordPrefix(bytes);
  if (opcode != Opcode::kChunk || length != bytes.size() - kRecordPrefixBytes) {
    return Err(Damaged(segment, "is not where the index says"));
  }
  const auto content = std::span(bytes).subspan(kRecordPrefixBytes);
  ChunkHeader header;
  if (!Parse(content, header)) return Err(Damaged(segment, "its header is damaged"));
  if (Status status = CheckHeader(segment, header); !status.ok()) return Err(std::move(status));
  // The packed records follow the fields, whose length depends on one string only.
  const std::uint64_t fields_bytes = ChunkContentBytes(header) - header.compressed_size;
  if (header.compressed_size > content.size() - fields_bytes) {
    return Err(Damaged(segment, "claims more bytes than it has"));
  }
  // Before the memory is allocated: a few kilobytes can claim to unpack to gigabytes.
  if (Status status = budget.Take(header.uncompressed_size); !status.ok())
    return Err(std::move(status));
  const auto packed = content.subspan(static_cast<std::size_t>(fields_bytes),
                                      static_cast<std::size_t>(header.compressed_size));
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
    // Empty messages take few bytes each; without a limit a chunk of them would fill the memory
    // with entries.
    if (content.entries.size() == kMaxChunkMessages) {
      return Damaged(segment, fmt::format("holds more than {} messages", kMaxChunkMessages));
    }
    content.entries.push_back(
        {.log_time = message.log_time, .offset = record->offset, .channel_id = message.channel_id});
  }
  if (!walker.AtEnd()) return Damaged(segment, "its records are damaged");
  // Stable, so that messages of one time keep the order in which they were written.
  std::stable_sort(content.entries.begin(), content.entries.end(),
                   [](const auto& a, const auto& b) { return a.log_time < b.log_time; });
  return OkStatus();
}

}  // namespace

bool IsSupportedCompression(std::string_view compression) {
  return compression.empty() || compression == "zstd";
}

Status UnpackBudget::Take(std::uint64_t bytes) {
  if (bytes <= left_ && !exhausted_) {
    left_ -= bytes;
    return OkStatus();
  }
  // For good, even if a later chunk is small: the file does not become a scan by that.
  exhausted_ = true;
  return ResourceExhausted(fmt::format(
      "reading was given up: unpacking the file takes more than {} MB and {} times its size, which "
      "no scan does",
      kFloorBytes >> 20, kMaxRatio));
}

std::uint64_t ChunkContentBytes(const ChunkHeader& header) {
  return 8 + 8 + 8 + 4 + 4 + header.compression.size() + 8 + header.compressed_size;
}

void Definitions::Add(const RecordWalker::Record& record) {
  if (record.content.size() > kMaxDefinitionBytes) return;
  if (record.opcode == Opcode::kSchema) {
    Schema schema;
    if (Parse(record.content, schema)) AddNew(std::move(schema));
  } else if (record.opcode == Opcode::kChannel) {
    Channel channel;
    if (Parse(record.content, channel)) AddNew(std::move(channel));
  }
}

void Definitions::Merge(Definitions&& other) {
  for (auto& [id, schema] : other.schemas) AddNew(std::move(schema));
  for (auto& [id, channel] : other.channels) AddNew(std::move(channel));
}

void Definitions::AddNew(Schema schema) {
  const std::size_t size = schema.name.size() + schema.encoding.size() + schema.data.size();
  // Definitions are repeated in each chunk; the first one counts, and one that differs later cannot
  // change what was read.
  if (schema.id == 0 || schemas.contains(schema.id) || !Fits(size)) return;
  const SchemaId id = schema.id;
  schemas.emplace(id, std::move(schema));
}

void Definitions::AddNew(Channel channel) {
  constexpr std::size_t kEntryBytes = 128;  // What a map takes for an entry without text.
  std::size_t size = channel.topic.size() + channel.message_encoding.size();
  for (const auto& [key, value] : channel.metadata) size += kEntryBytes + key.size() + value.size();
  if (channels.contains(channel.id) || !Fits(size)) return;
  const ChannelId id = channel.id;
  channels.emplace(id, std::move(channel));
}

bool Definitions::Fits(std::size_t size) {
  if (size > kMaxDefinitionsBytes - bytes_) return false;
  bytes_ += size;
  return true;
}

Result<SegmentContent> ReadSegment(const ByteSource& source, const Segment& segment,
                                   UnpackBudget& budget) {
  // Compression never grows a chunk by more than a small fraction.
  if (segment.length > kMaxChunkBytes + kMaxChunkBytes / 64 ||
      segment.length < kRecordPrefixBytes || segment.offset > source.size() ||
      segment.length > source.size() - segment.offset) {
    return Err(
        Damaged(segment, fmt::format("its length of {} bytes is impossible", segment.length)));
  }
  if (Status status = budget.Take(segment.length); !status.ok()) return Err(std::move(status));
  Bytes bytes(static_cast<std::size_t>(segment.length));
  if (Status status = source.Read(segment.offset, bytes); !status.ok())
    return Err(std::move(status));
  SegmentContent content;
  if (segment.is_chunk) {
    Result<Bytes> records = UnpackChunk(segment, bytes, budget);
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
