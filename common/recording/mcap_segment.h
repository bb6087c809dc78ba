#pragma once

#include <vector>

#include "common/recording/byte_stream.h"
#include "common/recording/mcap_records.h"

namespace isotherm::mcap {

/// Larger chunks are refused: they would break the promise of bounded memory.
inline constexpr std::uint64_t kMaxChunkBytes = 128U << 20;

/// Of a chunk: none and zstd.
bool IsSupportedCompression(std::string_view compression);

/// A stretch of the file that holds messages: a chunk record, or records that lie in no chunk.
struct Segment {
  bool is_chunk = true;
  std::uint64_t offset = 0;
  std::uint64_t length = 0;
  std::uint64_t start = 0;  ///< Earliest log time.
  std::uint64_t end = 0;    ///< Latest log time.
};

/// Schemas and channels by id. They are the same wherever they appear in a file.
struct Definitions {
  std::map<SchemaId, Schema> schemas;
  std::map<ChannelId, Channel> channels;

  /// Adds the record if it is a schema or a channel.
  void Add(const RecordWalker::Record& record);
};

/// The uncompressed records of a segment and where its messages are in them.
struct SegmentContent {
  struct Entry {
    std::uint64_t log_time = 0;
    std::size_t offset = 0;  ///< Of the message record.
    ChannelId channel_id = 0;
  };
  Bytes records;
  std::vector<Entry> entries;  ///< In the order of log time; of equal times, in file order.
  Definitions definitions;
};

/// Reads, checks (sizes, CRC, structure) and unpacks a segment. kDataLoss if it is damaged.
Result<SegmentContent> ReadSegment(const ByteSource& source, const Segment& segment);

/// The message that `entry` refers to; nullopt if `entry` is not of this content.
std::optional<Message> MessageAt(const SegmentContent& content, const SegmentContent::Entry& entry);

}  // namespace isotherm::mcap
