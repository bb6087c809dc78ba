#include "common/recording/mcap_records.h"

#include <zlib.h>

#include <algorithm>
#include <concepts>
#include <type_traits>

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
  void Put(Opcode opcode) { Put(static_cast<std::uint8_t>(opcode)); }
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

/// `T` is `Record`, to be written, or to be read into.
template <typename T, typename Record>
concept Like = std::same_as<std::remove_const_t<T>, Record>;

// The fields of each record in the specification's order, for writing and for reading.
void VisitFields(Like<Header> auto& record, const auto& visit) {
  visit(record.profile, record.library);
}
void VisitFields(Like<Footer> auto& record, const auto& visit) {
  visit(record.summary_start, record.summary_offset_start, record.summary_crc);
}
void VisitFields(Like<Schema> auto& record, const auto& visit) {
  visit(record.id, record.name, record.encoding, record.data);
}
void VisitFields(Like<Channel> auto& record, const auto& visit) {
  visit(record.id, record.schema_id, record.topic, record.message_encoding, record.metadata);
}
/// The data follow.
void VisitFields(Like<Message> auto& record, const auto& visit) {
  visit(record.channel_id, record.sequence, record.log_time, record.publish_time);
}
/// The records follow.
void VisitFields(Like<ChunkHeader> auto& record, const auto& visit) {
  visit(record.start, record.end, record.uncompressed_size, record.uncompressed_crc,
        record.compression, record.compressed_size);
}
/// The entries follow.
void VisitFields(Like<MessageIndex> auto& record, const auto& visit) { visit(record.channel_id); }
void VisitFields(Like<ChunkIndex> auto& record, const auto& visit) {
  visit(record.start, record.end, record.chunk_offset, record.chunk_length,
        record.message_index_offsets, record.message_index_length, record.compression,
        record.compressed_size, record.uncompressed_size);
}
void VisitFields(Like<Statistics> auto& record, const auto& visit) {
  visit(record.message_count, record.schema_count, record.channel_count, record.attachment_count,
        record.metadata_count, record.chunk_count, record.start, record.end,
        record.channel_message_counts);
}
void VisitFields(Like<Metadata> auto& record, const auto& visit) {
  visit(record.name, record.values);
}
void VisitFields(Like<MetadataIndex> auto& record, const auto& visit) {
  visit(record.offset, record.length, record.name);
}
void VisitFields(Like<SummaryOffset> auto& record, const auto& visit) {
  visit(record.group, record.start, record.length);
}
void VisitFields(Like<DataEnd> auto& record, const auto& visit) { visit(record.data_section_crc); }

void PutFields(const auto& record, RecordWriter& writer) {
  VisitFields(record, [&writer](const auto&... fields) { (writer.Put(fields), ...); });
}
void AppendRecord(Opcode opcode, const auto& record, Bytes& out) {
  RecordWriter writer(opcode, out);
  PutFields(record, writer);
}

void GetFields(FieldReader& reader, auto& record) {
  VisitFields(record, [&reader](auto&... fields) { (reader.Get(fields), ...); });
}
bool ParseRecord(std::span<const std::uint8_t> content, auto& record) {
  FieldReader reader(content);
  GetFields(reader, record);
  return reader.ok();
}

}  // namespace

void Append(const Header& record, Bytes& out) { AppendRecord(Opcode::kHeader, record, out); }
void Append(const Footer& record, Bytes& out) { AppendRecord(Opcode::kFooter, record, out); }
void Append(const Schema& record, Bytes& out) { AppendRecord(Opcode::kSchema, record, out); }
void Append(const Channel& record, Bytes& out) { AppendRecord(Opcode::kChannel, record, out); }
void Append(const ChunkIndex& record, Bytes& out) {
  AppendRecord(Opcode::kChunkIndex, record, out);
}
void Append(const Statistics& record, Bytes& out) {
  AppendRecord(Opcode::kStatistics, record, out);
}
void Append(const Metadata& record, Bytes& out) { AppendRecord(Opcode::kMetadata, record, out); }
void Append(const MetadataIndex& record, Bytes& out) {
  AppendRecord(Opcode::kMetadataIndex, record, out);
}
void Append(const SummaryOffset& record, Bytes& out) {
  AppendRecord(Opcode::kSummaryOffset, record, out);
}
void Append(const DataEnd& record, Bytes& out) { AppendRecord(Opcode::kDataEnd, record, out); }

void Append(const Message& record, Bytes& out) {
  RecordWriter writer(Opcode::kMessage, out);
  PutFields(record, writer);
  writer.PutRaw(record.data);
}

void Append(const ChunkHeader& header, std::span<const std::uint8_t> records, Bytes& out) {
  RecordWriter writer(Opcode::kChunk, out);
  PutFields(header, writer);
  writer.PutRaw(records);
}

void Append(const MessageIndex& record, Bytes& out) {
  RecordWriter writer(Opcode::kMessageIndex, out);
  PutFields(record, writer);
  const std::size_t begin = writer.BeginArray();
  for (const auto& [time, offset] : record.entries) {
    writer.Put(time);
    writer.Put(offset);
  }
  writer.EndArray(begin);
}

bool Parse(std::span<const std::uint8_t> content, Header& record) {
  return ParseRecord(content, record);
}
bool Parse(std::span<const std::uint8_t> content, Footer& record) {
  return ParseRecord(content, record);
}
bool Parse(std::span<const std::uint8_t> content, Schema& record) {
  return ParseRecord(content, record);
}
bool Parse(std::span<const std::uint8_t> content, Channel& record) {
  return ParseRecord(content, record);
}
bool Parse(std::span<const std::uint8_t> content, ChunkHeader& record) {
  return ParseRecord(content, record);
}
bool Parse(std::span<const std::uint8_t> content, ChunkIndex& record) {
  return ParseRecord(content, record);
}
bool Parse(std::span<const std::uint8_t> content, Statistics& record) {
  return ParseRecord(content, record);
}
bool Parse(std::span<const std::uint8_t> content, Metadata& record) {
  return ParseRecord(content, record);
}
bool Parse(std::span<const std::uint8_t> content, MetadataIndex& record) {
  return ParseRecord(content, record);
}
bool Parse(std::span<const std::uint8_t> content, DataEnd& record) {
  return ParseRecord(content, record);
}

bool Parse(std::span<const std::uint8_t> content, Message& record) {
  FieldReader fields(content);
  GetFields(fields, record);
  record.data = fields.rest();
  return fields.ok();
}

bool Parse(std::span<const std::uint8_t> content, MessageIndex& record) {
  FieldReader fields(content);
  GetFields(fields, record);
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
