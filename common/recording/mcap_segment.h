#pragma once

#include <vector>

#include "common/recording/byte_stream.h"
#include "common/recording/mcap_records.h"

namespace isotherm::mcap {

/// Limits of what is unpacked, whatever a file claims. Larger chunks are refused: they would break
/// the promise of bounded memory, which is 256 MB for a program that reads a recording.
inline constexpr std::uint64_t kMaxChunkBytes = 40U << 20;
inline constexpr std::size_t kMaxChunkMessages = 1U << 18;
/// Schemas and channels that are longer, or more than these bytes of them, are left out.
inline constexpr std::size_t kMaxDefinitionBytes = 1U << 20;
inline constexpr std::size_t kMaxDefinitionsBytes = 16U << 20;
/// Metadata beyond this is left out.
inline constexpr std::size_t kMaxMetadataBytes = 4U << 20;

/// Limits how much one pass over a file may unpack, so that a small file cannot keep a program busy
/// for long. Frames of real cameras pack to a tenth at best.
class UnpackBudget {
 public:
  /// Small files may unpack to this much in any case.
  static constexpr std::uint64_t kFloorBytes = 64U << 20;
  /// Twenty times what frames of real cameras reach; compression bombs go beyond 1000.
  static constexpr std::uint64_t kMaxRatio = 200;

  explicit UnpackBudget(std::uint64_t file_bytes) : left_(kFloorBytes + kMaxRatio * file_bytes) {}

  /// kResourceExhausted if `bytes` are more than what is left; then nothing is left any more.
  Status Take(std::uint64_t bytes);
  bool exhausted() const { return exhausted_; }

 private:
  std::uint64_t left_;
  bool exhausted_ = false;
};

/// Returns whether a chunk of this compression can be read: none and zstd.
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
class Definitions {
 public:
  std::map<SchemaId, Schema> schemas;
  std::map<ChannelId, Channel> channels;

  /// Adds the record if it is a schema or a channel within the limits.
  void Add(const RecordWalker::Record& record);
  /// Adds what `other` has and this has not, if that stays within the limits.
  void Merge(Definitions&& other);

 private:
  void AddNew(Schema schema);
  void AddNew(Channel channel);
  bool Fits(std::size_t size);

  std::size_t bytes_ = 0;  ///< Sum of their sizes.
};

/// The uncompressed records of a segment and where its messages are in them.
struct SegmentContent {
  /// Says when a message was logged and where it lies.
  struct Entry {
    std::uint64_t log_time = 0;
    std::size_t offset = 0;  ///< Place of the message record.
    ChannelId channel_id = 0;
  };
  Bytes records;
  std::vector<Entry> entries;  ///< In the order of log time; of equal times, in file order.
  Definitions definitions;
};

/// Content bytes of the chunk record that starts with these fields; the packed records are the last
/// of them.
std::uint64_t ChunkContentBytes(const ChunkHeader& header);

/// Reads, checks (sizes, CRC, structure) and unpacks a segment, which `budget` pays for. kDataLoss
/// if it is damaged, kResourceExhausted if the budget is not enough.
Result<SegmentContent> ReadSegment(const ByteSource& source, const Segment& segment,
                                   UnpackBudget& budget);

/// The message that `entry` refers to; nullopt if `entry` is not of this content.
std::optional<Message> MessageAt(const SegmentContent& content, const SegmentContent::Entry& entry);

}  // namespace isotherm::mcap
