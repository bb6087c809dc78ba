#include "common/recording/mcap_records.h"

#include <zlib.h>

#include <algorithm>
#include <concepts>

namespace isotherm::mcap {
namespace {

/// Writes one record: the prefix when it is made, the length when it is destroyed.
class RecordWriter {
 public:
  RecordWriter(Opcode opcode, Bytes& out) : out_(out) {
    out_.push_back(static_cast<std::uint8_t>(opcode));
    // The length is not known yet; the destructor writes it here, since a record's end is where its
    // scope ends.
    Put(std::uint64_t{0});
    content_begin_ = out_.size();
  }
  RecordWriter(const RecordWriter&) = delete;
  RecordWriter& operator=(const RecordWriter&) = delete;
  ~RecordWriter() { Patch<std::uint64_t>(content_begin_ - sizeof(std::uint64_t), content_begin_); }

  template <std::unsigned_integral T>
  void Put(T value) {
    for (std::size_t i = 0; i < sizeof(T); ++i) {
      // MCAP is little-endian; shifts give that on every processor.
      out_.push_back(static_cast<std::uint8_t>(static_cast<std::uint64_t>(value) >> (8 * i)));
    }
  }
  void Put(std::string_view text) {
    Put(static_cast<std::uint32_t>(text.size()));
    out_.insert(out_.end(), text.begin(), text.end());
  }
  void PutRaw(std::span<const std::uint8_t> bytes) {
    out_.insert(out_.end(), bytes.begin(), bytes.end());
  }
  template <typename Key, typename Value>
  void Put(const std::map<Key, Value>& map) {
    const std::size_t begin = BeginArray();
    for (const auto& [key, value] : map) {
      PutElement(key);
      PutElement(value);
    }
    EndArray(begin);
  }
  std::size_t BeginArray() {
    Put(std::uint32_t{0});
    return out_.size();
  }
  /// Arrays and maps start with their length in bytes.
  void EndArray(std::size_t begin) { Patch<std::uint32_t>(begin - sizeof(std::uint32_t), begin); }

 private:
  template <std::unsigned_integral T>
  void PutElement(T value) {
    Put(value);
  }
  void PutElement(const std::string& value) { Put(std::string_view(value)); }

  /// Stores at `at` how many bytes were written since `begin`.
  template <std::unsigned_integral T>
  void Patch(std::size_t at, std::size_t begin) {
    const std::uint64_t length = out_.size() - begin;
    for (std::size_t i = 0; i < sizeof(T); ++i) {
      out_[at + i] = static_cast<std::uint8_t>(length >> (8 * i));
    }
  }

  Bytes& out_;
  std::size_t content_begin_ = 0;
};

/// Reads fields in order; once something does not fit, everything reads as zero and ok() is false.
class FieldReader {
 public:
  explicit FieldReader(std::span<const std::uint8_t> bytes) : rest_(bytes) {}

  bool ok() const { return ok_; }
  bool empty() const { return rest_.empty(); }
  std::span<const std::uint8_t> rest() const { return rest_; }

  template <std::unsigned_integral T>
  void Get(T& value) {
    const std::span<const std::uint8_t> bytes = Take(sizeof(T));
    std::uint64_t number = 0;
    for (std::size_t i = 0; i < bytes.size(); ++i) number |= std::uint64_t{bytes[i]} << (8 * i);
    value = static_cast<T>(number);
  }
  template <std::unsigned_integral T>
  T Get() {
    T value = 0;
    Get(value);
    return value;
  }
  void Get(std::string& text) {
    const std::span<const std::uint8_t> bytes = GetArray();
    text.assign(bytes.begin(), bytes.end());
  }
  std::span<const std::uint8_t> GetArray() { return Take(Get<std::uint32_t>()); }
  template <typename Key, typename Value>
  void Get(std::map<Key, Value>& map) {
    FieldReader entries(GetArray());
    while (ok_ && !entries.empty()) {
      Key key{};
      Value value{};
      entries.Get(key);
      entries.Get(value);
      // Damage inside of the map counts as damage of the record.
      ok_ = entries.ok();
      map[std::move(key)] = std::move(value);
    }
  }

 private:
  std::span<const std::uint8_t> Take(std::size_t count) {
    // Lengths come from the file and may be anything: nothing is believed beyond the bytes that are
    // there.
    if (!ok_ || count > rest_.size()) {
      ok_ = false;
      rest_ = {};
      return {};
    }
    const std::span<const std::uint8_t> taken = rest_.first(count);
    rest_ = rest_.subspan(count);
    return taken;
  }

  std::span<const std::uint8_t> rest_;
  bool ok_ = true;
};

}  // namespace

void Append(const Header& record, Bytes& out) {
  RecordWriter writer(Opcode::kHeader, out);
  writer.Put(record.profile);
  writer.Put(record.library);
}

void Append(const Footer& record, Bytes& out) {
  RecordWriter writer(Opcode::kFooter, out);
  writer.Put(record.summary_start);
  writer.Put(record.summary_offset_start);
  writer.Put(record.summary_crc);
}

void Append(const Schema& record, Bytes& out) {
  RecordWriter writer(Opcode::kSchema, out);
  writer.Put(record.id);
  writer.Put(record.name);
  writer.Put(record.encoding);
  writer.Put(record.data);
}

void Append(const Channel& record, Bytes& out) {
  RecordWriter writer(Opcode::kChannel, out);
  writer.Put(record.id);
  writer.Put(record.schema_id);
  writer.Put(record.topic);
  writer.Put(record.message_encoding);
  writer.Put(record.metadata);
}

void Append(const Message& record, Bytes& out) {
  RecordWriter writer(Opcode::kMessage, out);
  writer.Put(record.channel_id);
  writer.Put(record.sequence);
  writer.Put(record.log_time);
  writer.Put(record.publish_time);
  writer.PutRaw(record.data);
}

void Append(const ChunkHeader& header, std::span<const std::uint8_t> records, Bytes& out) {
  RecordWriter writer(Opcode::kChunk, out);
  writer.Put(header.start);
  writer.Put(header.end);
  writer.Put(header.uncompressed_size);
  writer.Put(header.uncompressed_crc);
  writer.Put(header.compression);
  writer.Put(header.compressed_size);
  writer.PutRaw(records);
}

void Append(const MessageIndex& record, Bytes& out) {
  RecordWriter writer(Opcode::kMessageIndex, out);
  writer.Put(record.channel_id);
  const std::size_t begin = writer.BeginArray();
  for (const auto& [time, offset] : record.entries) {
    writer.Put(time);
    writer.Put(offset);
  }
  writer.EndArray(begin);
}

void Append(const ChunkIndex& record, Bytes& out) {
  RecordWriter writer(Opcode::kChunkIndex, out);
  writer.Put(record.start);
  writer.Put(record.end);
  writer.Put(record.chunk_offset);
  writer.Put(record.chunk_length);
  writer.Put(record.message_index_offsets);
  writer.Put(record.message_index_length);
  writer.Put(record.compression);
  writer.Put(record.compressed_size);
  writer.Put(record.uncompressed_size);
}

void Append(const Statistics& record, Bytes& out) {
  RecordWriter writer(Opcode::kStatistics, out);
  writer.Put(record.message_count);
  writer.Put(record.schema_count);
  writer.Put(record.channel_count);
  writer.Put(record.attachment_count);
  writer.Put(record.metadata_count);
  writer.Put(record.chunk_count);
  writer.Put(record.start);
  writer.Put(record.end);
  writer.Put(record.channel_message_counts);
}

void Append(const Metadata& record, Bytes& out) {
  RecordWriter writer(Opcode::kMetadata, out);
  writer.Put(record.name);
  writer.Put(record.values);
}

void Append(const MetadataIndex& record, Bytes& out) {
  RecordWriter writer(Opcode::kMetadataIndex, out);
  writer.Put(record.offset);
  writer.Put(record.length);
  writer.Put(record.name);
}

void Append(const SummaryOffset& record, Bytes& out) {
  RecordWriter writer(Opcode::kSummaryOffset, out);
  writer.Put(static_cast<std::uint8_t>(record.group));
  writer.Put(record.start);
  writer.Put(record.length);
}

void Append(const DataEnd& record, Bytes& out) {
  RecordWriter writer(Opcode::kDataEnd, out);
  writer.Put(record.data_section_crc);
}

bool Parse(std::span<const std::uint8_t> content, Header& record) {
  FieldReader fields(content);
  fields.Get(record.profile);
  fields.Get(record.library);
  return fields.ok();
}

bool Parse(std::span<const std::uint8_t> content, Footer& record) {
  FieldReader fields(content);
  fields.Get(record.summary_start);
  fields.Get(record.summary_offset_start);
  fields.Get(record.summary_crc);
  return fields.ok();
}

bool Parse(std::span<const std::uint8_t> content, Schema& record) {
  FieldReader fields(content);
  fields.Get(record.id);
  fields.Get(record.name);
  fields.Get(record.encoding);
  fields.Get(record.data);
  return fields.ok();
}

bool Parse(std::span<const std::uint8_t> content, Channel& record) {
  FieldReader fields(content);
  fields.Get(record.id);
  fields.Get(record.schema_id);
  fields.Get(record.topic);
  fields.Get(record.message_encoding);
  fields.Get(record.metadata);
  return fields.ok();
}

bool Parse(std::span<const std::uint8_t> content, Message& record) {
  FieldReader fields(content);
  fields.Get(record.channel_id);
  fields.Get(record.sequence);
  fields.Get(record.log_time);
  fields.Get(record.publish_time);
  record.data = fields.rest();
  return fields.ok();
}

bool Parse(std::span<const std::uint8_t> content, ChunkHeader& record) {
  FieldReader fields(content);
  fields.Get(record.start);
  fields.Get(record.end);
  fields.Get(record.uncompressed_size);
  fields.Get(record.uncompressed_crc);
  fields.Get(record.compression);
  fields.Get(record.compressed_size);
  return fields.ok();
}

bool Parse(std::span<const std::uint8_t> content, MessageIndex& record) {
  FieldReader fields(content);
  fields.Get(record.channel_id);
  FieldReader entries(fields.GetArray());
  constexpr std::size_t kEntryBytes = 16;
  record.entries.reserve(entries.rest().size() / kEntryBytes);
  while (entries.rest().size() >= kEntryBytes) {
    auto& entry = record.entries.emplace_back();
    entries.Get(entry.first);
    entries.Get(entry.second);
  }
  return fields.ok();
}

bool Parse(std::span<const std::uint8_t> content, ChunkIndex& record) {
  FieldReader fields(content);
  fields.Get(record.start);
  fields.Get(record.end);
  fields.Get(record.chunk_offset);
  fields.Get(record.chunk_length);
  fields.Get(record.message_index_offsets);
  fields.Get(record.message_index_length);
  fields.Get(record.compression);
  fields.Get(record.compressed_size);
  fields.Get(record.uncompressed_size);
  return fields.ok();
}

bool Parse(std::span<const std::uint8_t> content, Statistics& record) {
  FieldReader fields(content);
  fields.Get(record.message_count);
  fields.Get(record.schema_count);
  fields.Get(record.channel_count);
  fields.Get(record.attachment_count);
  fields.Get(record.metadata_count);
  fields.Get(record.chunk_count);
  fields.Get(record.start);
  fields.Get(record.end);
  fields.Get(record.channel_message_counts);
  return fields.ok();
}

bool Parse(std::span<const std::uint8_t> content, Metadata& record) {
  FieldReader fields(content);
  fields.Get(record.name);
  fields.Get(record.values);
  return fields.ok();
}

bool Parse(std::span<const std::uint8_t> content, MetadataIndex& record) {
  FieldReader fields(content);
  fields.Get(record.offset);
  fields.Get(record.length);
  fields.Get(record.name);
  return fields.ok();
}

bool Parse(std::span<const std::uint8_t> content, DataEnd& record) {
  FieldReader fields(content);
  fields.Get(record.data_section_crc);
  return fields.ok();
}

std::pair<Opcode, std::uint64_t> ParseRecordPrefix(std::span<const std::uint8_t> bytes) {
  FieldReader fields(bytes);
  const auto opcode = static_cast<Opcode>(fields.Get<std::uint8_t>());
  return {opcode, fields.Get<std::uint64_t>()};
}

std::optional<RecordWalker::Record> RecordWalker::Next() {
  if (rest_.size() < kRecordPrefixBytes) return std::nullopt;
  const auto [opcode, length] = ParseRecordPrefix(rest_);
  if (length > rest_.size() - kRecordPrefixBytes) return std::nullopt;
  Record record{.opcode = opcode,
                .offset = size_ - rest_.size(),
                .content = rest_.subspan(kRecordPrefixBytes, static_cast<std::size_t>(length))};
  rest_ = rest_.subspan(kRecordPrefixBytes + static_cast<std::size_t>(length));
  return record;
}

std::uint32_t Crc32(std::span<const std::uint8_t> bytes, std::uint32_t crc) {
  return static_cast<std::uint32_t>(::crc32_z(crc, bytes.data(), bytes.size()));
}

}  // namespace isotherm::mcap
