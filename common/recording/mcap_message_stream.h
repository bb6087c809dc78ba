#pragma once

#include <list>
#include <memory>
#include <vector>

#include "common/recording/mcap_file_index.h"

namespace isotherm::mcap {

/// Delivers the messages of a file in the order of log time (of equal times: file order), however
/// its chunks overlap. Holds at most `cache_bytes` of unpacked chunks, or the one chunk that is
/// needed if that is larger, and a few bytes per message of the chunks that overlap, of which there
/// are at most kMaxOpenMessages. One pass unpacks no more than an UnpackBudget allows.
/// Thread-compatible.
class MessageStream {
 public:
  /// Eight unpacked chunks of 4 MB. Smaller: chunks that overlap in time are unpacked again and
  /// again while they are merged. Not tuned.
  static constexpr std::size_t kDefaultCacheBytes = 32U << 20;
  /// Entries of 16 bytes that may be open at once: 16 MB, whatever a file claims.
  static constexpr std::size_t kMaxOpenMessages = 1U << 20;

  /// `source` and `index` must outlive the stream.
  MessageStream(const ByteSource& source, const FileIndex& index,
                std::size_t cache_bytes = kDefaultCacheBytes);

  /// The next message, whose data is valid until the next call; nullopt at the end. On an error (a
  /// damaged chunk) the next call goes on behind it; after kResourceExhausted there is nothing
  /// more.
  Result<std::optional<Message>> Next();

  /// Goes on with the first message at or after `log_time`.
  void Seek(std::uint64_t log_time);

 private:
  /// Points to the next message of an open segment.
  struct Cursor {
    std::size_t segment = 0;
    std::vector<SegmentContent::Entry> entries;
    std::size_t position = 0;

    std::uint64_t log_time() const { return entries[position].log_time; }
  };
  /// Keeps a segment's content for messages that are read out of order.
  struct Cached {
    std::size_t segment = 0;
    std::shared_ptr<const SegmentContent> content;
  };
  /// Orders a heap with the earliest message on top.
  static bool IsLater(const Cursor& a, const Cursor& b);

  Status OpenSegment(std::size_t segment);
  Result<std::shared_ptr<const SegmentContent>> Content(std::size_t segment);
  void TrimCache();
  void CloseLastCursor();

  const ByteSource& source_;
  const FileIndex& index_;
  const std::size_t cache_bytes_;
  std::vector<std::size_t> order_;  ///< Segments by start time.
  std::size_t next_in_order_ = 0;
  UnpackBudget budget_;
  std::size_t open_messages_ = 0;                  ///< All cursors together.
  std::uint64_t begin_ = 0;                        ///< Earlier messages are skipped.
  std::vector<Cursor> cursors_;                    ///< Heap.
  std::list<Cached> cache_;                        ///< Most recently used first.
  std::shared_ptr<const SegmentContent> current_;  ///< Keeps the last message's data.
};

}  // namespace isotherm::mcap
