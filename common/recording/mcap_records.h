#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "common/base/status.h"

/// The records of the MCAP container (public specification, version 0): plain structs, their bytes,
/// nothing else. All numbers are little-endian; every record is u8 opcode, u64 length, content.
namespace isotherm::mcap {

inline constexpr std::array<std::uint8_t, 8> kMagic = {0x89, 'M', 'C', 'A', 'P', '0', '\r', '\n'};
inline constexpr std::size_t kRecordPrefixBytes = 1 + 8;
/// The footer record and the magic behind it have a fixed size.
inline constexpr std::size_t kFooterRecordBytes = kRecordPrefixBytes + 8 + 8 + 4;

/// Names the kinds of records.
enum class Opcode : std::uint8_t {
  kHeader = 0x01,
  kFooter = 0x02,
  kSchema = 0x03,
  kChannel = 0x04,
  kMessage = 0x05,
  kChunk = 0x06,
  kMessageIndex = 0x07,
  kChunkIndex = 0x08,
  kAttachment = 0x09,
  kAttachmentIndex = 0x0A,
  kStatistics = 0x0B,
  kMetadata = 0x0C,
  kMetadataIndex = 0x0D,
  kSummaryOffset = 0x0E,
  kDataEnd = 0x0F,
};

using ChannelId = std::uint16_t;
using SchemaId = std::uint16_t;

/// The first record of a file.
struct Header {
  std::string profile;
  std::string library;
};

/// The last record: where the summary lies. A file that was cut off has none.
struct Footer {
  std::uint64_t summary_start = 0;  ///< 0 = no summary.
  std::uint64_t summary_offset_start = 0;
  std::uint32_t summary_crc = 0;  ///< 0 = not computed.
};

/// Describes the type of a channel's messages.
struct Schema {
  SchemaId id = 0;
  std::string name;
  std::string encoding;
  std::string data;
};

/// Describes one stream of messages.
struct Channel {
  ChannelId id = 0;
  SchemaId schema_id = 0;  ///< 0 = none.
  std::string topic;
  std::string message_encoding;
  std::map<std::string, std::string> metadata;
};

/// Times are nanoseconds since the Unix epoch. `data` refers to the parsed buffer.
struct Message {
  ChannelId channel_id = 0;
  std::uint32_t sequence = 0;
  std::uint64_t log_time = 0;
  std::uint64_t publish_time = 0;
  std::span<const std::uint8_t> data;
};

/// Everything of a chunk record but its (compressed) records, which follow.
struct ChunkHeader {
  std::uint64_t start = 0;
  std::uint64_t end = 0;
  std::uint64_t uncompressed_size = 0;
  std::uint32_t uncompressed_crc = 0;  ///< 0 = not computed.
  std::string compression;
  std::uint64_t compressed_size = 0;
};

/// Time and offset in the uncompressed chunk of each message of one channel.
struct MessageIndex {
  ChannelId channel_id = 0;
  std::vector<std::pair<std::uint64_t, std::uint64_t>> entries;
};

/// Tells where a chunk lies and what time it spans, so that a reader can seek without reading it.
struct ChunkIndex {
  std::uint64_t start = 0;
  std::uint64_t end = 0;
  std::uint64_t chunk_offset = 0;  ///< Place of the chunk record in the file.
  std::uint64_t chunk_length = 0;  ///< With opcode and length.
  std::map<ChannelId, std::uint64_t> message_index_offsets;
  std::uint64_t message_index_length = 0;
  std::string compression;
  std::uint64_t compressed_size = 0;
  std::uint64_t uncompressed_size = 0;
};

/// Counts what is in the file.
struct Statistics {
  std::uint64_t message_count = 0;
  std::uint16_t schema_count = 0;
  std::uint32_t channel_count = 0;
  std::uint32_t attachment_count = 0;
  std::uint32_t metadata_count = 0;
  std::uint32_t chunk_count = 0;
  std::uint64_t start = 0;
  std::uint64_t end = 0;
  std::map<ChannelId, std::uint64_t> channel_message_counts;
};

/// Holds a named set of texts.
struct Metadata {
  std::string name;
  std::map<std::string, std::string> values;
};

/// Tells where a metadata record lies.
struct MetadataIndex {
  std::uint64_t offset = 0;
  std::uint64_t length = 0;  ///< With opcode and length.
  std::string name;
};

/// Tells where the records of one kind lie in the summary.
struct SummaryOffset {
  Opcode group = Opcode::kSchema;
  std::uint64_t start = 0;
  std::uint64_t length = 0;
};

/// Separates the data from the summary.
struct DataEnd {
  std::uint32_t data_section_crc = 0;  ///< 0 = not computed.
};

using Bytes = std::vector<std::uint8_t>;

/// Append one whole record to `out`.
void Append(const Header& record, Bytes& out);
void Append(const Footer& record, Bytes& out);
void Append(const Schema& record, Bytes& out);
void Append(const Channel& record, Bytes& out);
void Append(const Message& record, Bytes& out);
void Append(const MessageIndex& record, Bytes& out);
void Append(const ChunkIndex& record, Bytes& out);
void Append(const Statistics& record, Bytes& out);
void Append(const Metadata& record, Bytes& out);
void Append(const MetadataIndex& record, Bytes& out);
void Append(const SummaryOffset& record, Bytes& out);
void Append(const DataEnd& record, Bytes& out);
/// `records` has the `compressed_size` bytes that the header announces.
void Append(const ChunkHeader& header, std::span<const std::uint8_t> records, Bytes& out);

/// Parse the content of a record (without opcode and length). False: too short or inconsistent.
/// Bytes behind the known fields are ignored, as the specification asks for.
bool Parse(std::span<const std::uint8_t> content, Header& record);
bool Parse(std::span<const std::uint8_t> content, Footer& record);
bool Parse(std::span<const std::uint8_t> content, Schema& record);
bool Parse(std::span<const std::uint8_t> content, Channel& record);
bool Parse(std::span<const std::uint8_t> content, Message& record);
bool Parse(std::span<const std::uint8_t> content, ChunkHeader& record);
bool Parse(std::span<const std::uint8_t> content, MessageIndex& record);
bool Parse(std::span<const std::uint8_t> content, ChunkIndex& record);
bool Parse(std::span<const std::uint8_t> content, Statistics& record);
bool Parse(std::span<const std::uint8_t> content, Metadata& record);
bool Parse(std::span<const std::uint8_t> content, MetadataIndex& record);
bool Parse(std::span<const std::uint8_t> content, DataEnd& record);

/// Walks through records one after the other. Thread-compatible.
class RecordWalker {
 public:
  explicit RecordWalker(std::span<const std::uint8_t> records)
      : rest_(records), size_(records.size()) {}

  /// Refers to one record within the walked bytes.
  struct Record {
    Opcode opcode{};
    std::size_t offset = 0;  ///< Place of the opcode.
    std::span<const std::uint8_t> content;
  };
  /// nullopt at the end and where no whole record follows; see AtEnd().
  std::optional<Record> Next();
  bool AtEnd() const { return rest_.empty(); }

 private:
  std::span<const std::uint8_t> rest_;
  std::size_t size_;
};

/// Opcode and content length of a record from its first kRecordPrefixBytes bytes.
std::pair<Opcode, std::uint64_t> ParseRecordPrefix(std::span<const std::uint8_t> bytes);

/// CRC-32 as in zlib, continued from `crc`.
std::uint32_t Crc32(std::span<const std::uint8_t> bytes, std::uint32_t crc = 0);

}  // namespace isotherm::mcap
