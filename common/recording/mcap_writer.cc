#include "common/recording/mcap_writer.h"

#include <fmt/format.h>
#include <zstd.h>

#include <algorithm>
#include <utility>

#include "common/base/check.h"
#include "common/recording/mcap_summary.h"

namespace isotherm::mcap {
namespace {

std::uint64_t CountOf(ChannelId channel, const Statistics& statistics) {
  const auto found = statistics.channel_message_counts.find(channel);
  return found == statistics.channel_message_counts.end() ? 0 : found->second;
}

}  // namespace

void Writer::ZstdDeleter::operator()(ZSTD_CCtx_s* context) const { ZSTD_freeCCtx(context); }

Writer::Writer(std::unique_ptr<ByteSink> sink, WriterOptions options)
    : sink_(std::move(sink)), options_(std::move(options)), zstd_(ZSTD_createCCtx()) {
  CHECK(zstd_ != nullptr);
  ZSTD_CCtx_setParameter(zstd_.get(), ZSTD_c_compressionLevel, options_.zstd_level);
}

Writer::~Writer() { static_cast<void>(Close()); }

Result<std::unique_ptr<Writer>> Writer::Create(std::unique_ptr<ByteSink> sink,
                                               WriterOptions options) {
  std::unique_ptr<Writer> writer(new Writer(std::move(sink), std::move(options)));
  Bytes start(kMagic.begin(), kMagic.end());
  Append(Header{.profile = "", .library = writer->options_.library}, start);
  if (Status status = writer->WriteBytes(start); !status.ok()) return Err(std::move(status));
  return writer;
}

SchemaId Writer::AddSchema(std::string_view name, std::string_view encoding,
                           std::string_view data) {
  // 0 means "no schema" in the format.
  const auto id = static_cast<SchemaId>(schemas_.size() + 1);
  schemas_.push_back({.id = id,
                      .name = std::string(name),
                      .encoding = std::string(encoding),
                      .data = std::string(data)});
  return id;
}

ChannelId Writer::AddChannel(SchemaId schema, std::string_view topic,
                             std::string_view message_encoding) {
  CHECK(schema <= schemas_.size());
  const auto id = static_cast<ChannelId>(channels_.size() + 1);
  channels_.push_back({.id = id,
                       .schema_id = schema,
                       .topic = std::string(topic),
                       .message_encoding = std::string(message_encoding),
                       .metadata = {}});
  sequences_.push_back(0);
  return id;
}

Status Writer::WriteMessage(ChannelId channel, std::uint64_t log_time, std::uint64_t publish_time,
                            std::span<const std::uint8_t> data) {
  CHECK(channel >= 1 && channel <= channels_.size() && !closed_);
  if (!failure_.ok()) return failure_;
  if (data.size() > kMaxMessageBytes) {
    return InvalidArgument(fmt::format("message of {} bytes on {} exceeds the limit of {}",
                                       data.size(), channels_[channel - 1U].topic,
                                       kMaxMessageBytes));
  }
  if (!chunk_.records.empty()) {
    const std::uint64_t start = std::min(chunk_.start, log_time);
    const std::uint64_t end = std::max(chunk_.end, log_time);
    // A chunk ends before this message if the message would make it too long in time or too large
    // for a reader. By log time and not by the clock, so that the same messages give the same file.
    if (end - start > options_.chunk_duration_ns ||
        chunk_.records.size() + data.size() > kMaxMessageBytes) {
      ISOTHERM_RETURN_IF_ERROR(Flush());
    }
  }
  if (chunk_.records.empty()) chunk_.start = chunk_.end = log_time;
  chunk_.start = std::min(chunk_.start, log_time);
  chunk_.end = std::max(chunk_.end, log_time);

  MessageIndex& index = IndexFor(channel);
  index.entries.emplace_back(log_time, chunk_.records.size());
  Append(Message{.channel_id = channel,
                 .sequence = sequences_[channel - 1U]++,
                 .log_time = log_time,
                 .publish_time = publish_time,
                 .data = data},
         chunk_.records);
  return chunk_.records.size() >= options_.chunk_bytes ? Flush() : OkStatus();
}

MessageIndex& Writer::IndexFor(ChannelId channel) {
  const auto found =
      std::find_if(chunk_.indexes.begin(), chunk_.indexes.end(),
                   [channel](const auto& index) { return index.channel_id == channel; });
  if (found != chunk_.indexes.end()) return *found;
  const Channel& definition = channels_[channel - 1U];
  // Each chunk repeats what its messages need: a reader that finds only this chunk, behind damage,
  // understands it.
  if (definition.schema_id != 0 && chunk_.schemas.insert(definition.schema_id).second) {
    Append(schemas_[definition.schema_id - 1U], chunk_.records);
  }
  Append(definition, chunk_.records);
  return chunk_.indexes.emplace_back(MessageIndex{.channel_id = channel, .entries = {}});
}

Status Writer::WriteMetadata(const Metadata& metadata) {
  CHECK(!closed_);
  if (!failure_.ok()) return failure_;
  out_.clear();
  Append(metadata, out_);
  // Before the write, which moves the offset.
  const MetadataIndex index{.offset = offset_, .length = out_.size(), .name = metadata.name};
  ISOTHERM_RETURN_IF_ERROR(WriteBytes(out_));
  metadata_indexes_.push_back(index);
  ++statistics_.metadata_count;
  return OkStatus();
}

Status Writer::Flush() {
  if (!failure_.ok()) return failure_;
  if (!chunk_.records.empty()) {
    if (const Status written = WriteChunk(); !written.ok()) {
      SaveUnsynced();
      return written;
    }
    has_unsynced_ = options_.sync;
  }
  return has_unsynced_ ? SyncWhenDue() : OkStatus();
}

Status Writer::SyncWhenDue() {
  const SteadyTime begin = options_.clock != nullptr ? options_.clock->SteadyNow() : SteadyTime();
  if (begin < next_sync_) return OkStatus();
  failure_ = sink_->Sync();
  // What was not synced may or may not be on the disk, and trying again would not tell: the kernel
  // forgets the error.
  if (!failure_.ok()) {
    TakeBackUnsynced();
    return failure_;
  }
  synced_ = statistics_;
  has_unsynced_ = false;
  if (options_.clock == nullptr) return OkStatus();
  const SteadyTime end = options_.clock->SteadyNow();
  if (end - begin > kQuickSync) next_sync_ = end + std::min(end - begin, kMaxPause);
  return OkStatus();
}

void Writer::SaveUnsynced() {
  if (!has_unsynced_) return;
  if (!sink_->Sync().ok()) return TakeBackUnsynced();
  synced_ = statistics_;
  has_unsynced_ = false;
}

void Writer::TakeBackUnsynced() {
  unsynced_ = std::exchange(statistics_, std::move(synced_));
  has_unsynced_ = false;
}

Status Writer::WriteChunk() {
  compressed_.resize(ZSTD_compressBound(chunk_.records.size()));
  const std::size_t compressed_size =
      ZSTD_compress2(zstd_.get(), compressed_.data(), compressed_.size(), chunk_.records.data(),
                     chunk_.records.size());
  if (ZSTD_isError(compressed_size)) {
    failure_ = Internal(fmt::format("zstd: {}", ZSTD_getErrorName(compressed_size)));
    return failure_;
  }
  const ChunkHeader header{.start = chunk_.start,
                           .end = chunk_.end,
                           .uncompressed_size = chunk_.records.size(),
                           .uncompressed_crc = Crc32(chunk_.records),
                           .compression = "zstd",
                           .compressed_size = compressed_size};
  out_.clear();
  Append(header, std::span(compressed_).first(compressed_size), out_);
  ChunkIndex index{.start = header.start,
                   .end = header.end,
                   .chunk_offset = offset_,
                   .chunk_length = out_.size(),
                   .message_index_offsets = {},
                   .message_index_length = 0,
                   .compression = header.compression,
                   .compressed_size = header.compressed_size,
                   .uncompressed_size = header.uncompressed_size};
  ISOTHERM_RETURN_IF_ERROR(WriteBytes(out_));
  // From here on the messages are in the file, even if their indexes do not fit.
  AddToStatistics(chunk_);
  // The summary's index of this chunk is added only when its message indexes are complete.
  ISOTHERM_RETURN_IF_ERROR(WriteMessageIndexes(index));
  chunk_indexes_.push_back(std::move(index));
  return OkStatus();
}

Status Writer::WriteMessageIndexes(ChunkIndex& index) {
  out_.clear();
  for (const MessageIndex& messages : chunk_.indexes) {
    index.message_index_offsets[messages.channel_id] = offset_ + out_.size();
    Append(messages, out_);
  }
  index.message_index_length = out_.size();
  // Also if the write below fails: the chunk is in the file, and must not be written twice.
  chunk_.records.clear();
  chunk_.indexes.clear();
  chunk_.schemas.clear();
  return WriteBytes(out_);
}

void Writer::AddToStatistics(const OpenChunk& chunk) {
  statistics_.start =
      statistics_.message_count == 0 ? chunk.start : std::min(statistics_.start, chunk.start);
  statistics_.end = std::max(statistics_.end, chunk.end);
  ++statistics_.chunk_count;
  for (const MessageIndex& index : chunk.indexes) {
    statistics_.message_count += index.entries.size();
    statistics_.channel_message_counts[index.channel_id] += index.entries.size();
  }
}

std::uint64_t Writer::message_count(ChannelId channel) const {
  std::uint64_t count = CountOf(channel, statistics_);
  if (!failure_.ok()) return count;  // What was still open is lost.
  for (const MessageIndex& index : chunk_.indexes) {
    if (index.channel_id == channel) count += index.entries.size();
  }
  return count;
}

std::uint64_t Writer::unsynced_count(ChannelId channel) const {
  return unsynced_ ? CountOf(channel, *unsynced_) - CountOf(channel, statistics_) : 0;
}

Status Writer::Close() {
  if (closed_) return failure_;
  if (failure_.ok() && !chunk_.records.empty() && WriteChunk().ok()) has_unsynced_ = options_.sync;
  // Also after a failure: the sink is closed in any case, and a second call returns what the first
  // did.
  closed_ = true;
  if (failure_.ok()) {
    Bytes end;
    Append(DataEnd{.data_section_crc = data_crc_}, end);
    AppendSummary({.schemas = schemas_,
                   .channels = channels_,
                   .statistics = statistics_,
                   .metadata_indexes = metadata_indexes_,
                   .chunk_indexes = chunk_indexes_},
                  offset_, end);
    if (WriteBytes(end).ok() && options_.sync) {
      failure_ = sink_->Sync();
      if (!failure_.ok() && has_unsynced_) TakeBackUnsynced();
      has_unsynced_ = false;
    }
  }
  SaveUnsynced();
  const Status closed = sink_->Close();
  if (failure_.ok()) failure_ = closed;
  return failure_;
}

Status Writer::WriteBytes(std::span<const std::uint8_t> bytes) {
  if (Status status = sink_->Write(bytes); !status.ok()) {
    failure_ = std::move(status);
    return failure_;
  }
  // Indexes and checksum count what the sink has taken, not what it was offered.
  offset_ += bytes.size();
  data_crc_ = Crc32(bytes, data_crc_);
  return OkStatus();
}

}  // namespace isotherm::mcap
