#pragma once

#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "common/recording/byte_stream.h"
#include "common/recording/mcap_records.h"
#include "common/time/clock.h"
#include "common/time/time_types.h"

struct ZSTD_CCtx_s;

namespace isotherm::mcap {

/// Says how chunks are cut and stored.
struct WriterOptions {
  std::string library;                 ///< Who wrote the file.
  std::size_t chunk_bytes = 4U << 20;  ///< A chunk is closed when its records reach this size.
  /// A chunk is closed before it would span more log time than this.
  std::uint64_t chunk_duration_ns = 500'000'000;
  bool sync = true;  ///< Sync the sink after each chunk.
  /// Measures how long a sync takes: one that takes long (kQuickSync) is followed by as much time
  /// without, kMaxPause at most, in which chunks are written, so that a slow disk keeps up.
  /// nullptr: each chunk is synced. Must outlive the writer.
  const Clock* clock = nullptr;
  int zstd_level = 1;
};

/// Writes an MCAP container: records are collected in chunks (zstd, CRC); each chunk goes out with
/// its message indexes and repeats the schemas and channels it needs, so that every
/// chunk can be read without any other. Close() adds the summary. After the first failure of the
/// sink nothing more is written and every call returns that failure. Thread-compatible.
class Writer {
 public:
  static Result<std::unique_ptr<Writer>> Create(std::unique_ptr<ByteSink> sink,
                                                WriterOptions options);
  ~Writer();
  Writer(const Writer&) = delete;
  Writer& operator=(const Writer&) = delete;

  SchemaId AddSchema(std::string_view name, std::string_view encoding, std::string_view data);
  ChannelId AddChannel(SchemaId schema, std::string_view topic, std::string_view message_encoding);

  /// kInvalidArgument for a message larger than kMaxMessageBytes; the file stays as it was. A chunk
  /// never becomes larger than a reader accepts (kMaxChunkBytes).
  Status WriteMessage(ChannelId channel, std::uint64_t log_time, std::uint64_t publish_time,
                      std::span<const std::uint8_t> data);
  Status WriteMetadata(const Metadata& metadata);
  /// Closes the current chunk, hands it to the sink, and syncs that if it is due.
  Status Flush();
  /// Idempotent: the second call returns what the first did.
  Status Close();

  /// Messages of `channel` that are in the file or still may get there.
  std::uint64_t message_count(ChannelId channel) const;
  /// Messages of `channel` that the sink took but did not sync: not counted above, and perhaps in
  /// the file all the same.
  std::uint64_t unsynced_count(ChannelId channel) const;
  /// Bytes handed to the sink.
  std::uint64_t bytes() const { return offset_; }

  /// A raw frame of 4096 x 4096 pixels of 16 bit fits; a message that is larger would make a chunk
  /// that readers refuse (kMaxChunkBytes).
  static constexpr std::size_t kMaxMessageBytes = 36U << 20;
  /// A disk that takes no longer has time enough between two chunks of half a second.
  static constexpr Nanoseconds kQuickSync = std::chrono::milliseconds(100);
  /// A disk that has stood still once is soon asked again. Not tuned.
  static constexpr Nanoseconds kMaxPause = std::chrono::seconds(5);

 private:
  /// Frees a compressor.
  struct ZstdDeleter {
    void operator()(ZSTD_CCtx_s* context) const;
  };
  /// Messages since the last flush.
  struct OpenChunk {
    Bytes records;
    std::vector<MessageIndex> indexes;  ///< By order of first use.
    std::set<SchemaId> schemas;
    std::uint64_t start = 0;
    std::uint64_t end = 0;
  };

  Writer(std::unique_ptr<ByteSink> sink, WriterOptions options);

  MessageIndex& IndexFor(ChannelId channel);
  Status WriteChunk();
  Status SyncWhenDue();
  /// After a write that failed: syncs the chunks before it, once.
  void SaveUnsynced();
  /// Chunks that were not synced do not count as written.
  void TakeBackUnsynced();
  /// Writes the indexes of the chunk that was just written; completes `index` and empties the
  /// chunk.
  Status WriteMessageIndexes(ChunkIndex& index);
  /// Writes and counts; remembers the first failure.
  Status WriteBytes(std::span<const std::uint8_t> bytes);
  void AddToStatistics(const OpenChunk& chunk);

  const std::unique_ptr<ByteSink> sink_;
  const WriterOptions options_;
  const std::unique_ptr<ZSTD_CCtx_s, ZstdDeleter> zstd_;

  std::vector<Schema> schemas_;           ///< Id = position + 1.
  std::vector<Channel> channels_;         ///< Id = position + 1.
  std::vector<std::uint32_t> sequences_;  ///< Next sequence number, by channel.
  OpenChunk chunk_;
  Bytes compressed_;
  Bytes out_;

  Statistics statistics_;      ///< They count what is in the file.
  Statistics synced_;          ///< The same as of the last sync.
  bool has_unsynced_ = false;  ///< There are chunks since.
  SteadyTime next_sync_{};
  std::optional<Statistics> unsynced_;  ///< As they would be if the last sync had not failed.
  std::vector<ChunkIndex> chunk_indexes_;
  std::vector<MetadataIndex> metadata_indexes_;
  std::uint64_t offset_ = 0;
  std::uint32_t data_crc_ = 0;
  Status failure_;
  bool closed_ = false;
};

}  // namespace isotherm::mcap
