#include "common/recording/mcap_message_stream.h"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <utility>

namespace isotherm::mcap {

MessageStream::MessageStream(const ByteSource& source, const FileIndex& index,
                             std::size_t cache_bytes)
    : source_(source),
      index_(index),
      cache_bytes_(cache_bytes),
      order_(index.segments.size()),
      budget_(source.size()) {
  std::iota(order_.begin(), order_.end(), std::size_t{0});
  // Chunks overlap in time where threads wrote into the file: they are opened by their beginnings
  // and merged like sorted lists, by a heap of one cursor each.
  std::stable_sort(order_.begin(), order_.end(), [this](std::size_t a, std::size_t b) {
    return index_.segments[a].start < index_.segments[b].start;
  });
}

bool MessageStream::IsLater(const Cursor& a, const Cursor& b) {
  // At equal times in file order, so that reading is deterministic.
  return std::pair(a.log_time(), a.segment) > std::pair(b.log_time(), b.segment);
}

void MessageStream::Seek(std::uint64_t log_time) {
  begin_ = log_time;
  // A seek reads chunks again, which is no attack.
  budget_ = UnpackBudget(source_.size());
  open_messages_ = 0;
  next_in_order_ = 0;
  cursors_.clear();
  current_.reset();
}

Result<std::optional<Message>> MessageStream::Next() {
  current_.reset();
  if (budget_.exhausted()) return std::nullopt;
  while (next_in_order_ < order_.size()) {
    const std::size_t segment = order_[next_in_order_];
    // A chunk that begins behind the next message cannot hold anything before it.
    if (!cursors_.empty() && index_.segments[segment].start > cursors_.front().log_time()) break;
    ++next_in_order_;
    // Skipped without being unpacked: that is what makes seeking fast.
    if (index_.segments[segment].end < begin_) continue;
    if (Status status = OpenSegment(segment); !status.ok()) return Err(std::move(status));
  }
  if (cursors_.empty()) return std::nullopt;

  std::pop_heap(cursors_.begin(), cursors_.end(), IsLater);
  Cursor& cursor = cursors_.back();
  auto content = Content(cursor.segment);
  if (!content) {  // It was readable when it was opened: too much overlaps, or the file is failing.
    CloseLastCursor();
    return Err(std::move(content.error()));
  }
  // Kept until the next call, since the message that is returned refers to it.
  current_ = std::move(*content);
  const std::optional<Message> message = MessageAt(*current_, cursor.entries[cursor.position]);
  if (!message) {
    CloseLastCursor();
    return Err(DataLoss("the file changed while it was read"));
  }
  if (++cursor.position < cursor.entries.size()) {
    std::push_heap(cursors_.begin(), cursors_.end(), IsLater);
  } else {
    // It was read to its end and will not be asked for again.
    cache_.remove_if([&cursor](const Cached& cached) { return cached.segment == cursor.segment; });
    CloseLastCursor();
  }
  return message;
}

void MessageStream::CloseLastCursor() {
  open_messages_ -= cursors_.back().entries.size();
  cursors_.pop_back();
}

Status MessageStream::OpenSegment(std::size_t segment) {
  auto content = Content(segment);
  if (!content) return content.error();
  // A file whose chunks all claim the same times would have all of them open at once.
  if ((*content)->entries.size() > kMaxOpenMessages - open_messages_) {
    return DataLoss(fmt::format("chunk at byte {}: too many chunks overlap it in time",
                                index_.segments[segment].offset));
  }
  Cursor cursor{.segment = segment, .entries = (*content)->entries};
  const auto first = std::find_if(cursor.entries.begin(), cursor.entries.end(),
                                  [this](const auto& entry) { return entry.log_time >= begin_; });
  cursor.position = static_cast<std::size_t>(first - cursor.entries.begin());
  if (first == cursor.entries.end()) return OkStatus();
  open_messages_ += cursor.entries.size();
  cursors_.push_back(std::move(cursor));
  std::push_heap(cursors_.begin(), cursors_.end(), IsLater);
  return OkStatus();
}

Result<std::shared_ptr<const SegmentContent>> MessageStream::Content(std::size_t segment) {
  const auto found = std::find_if(cache_.begin(), cache_.end(), [segment](const Cached& cached) {
    return cached.segment == segment;
  });
  if (found != cache_.end()) {
    // Newest use first, so that the one dropped is the one not needed for longest.
    cache_.splice(cache_.begin(), cache_, found);
    return cache_.front().content;
  }
  Result<SegmentContent> content = ReadSegment(source_, index_.segments[segment], budget_);
  if (!content) return Err(std::move(content.error()));
  cache_.push_front({segment, std::make_shared<const SegmentContent>(std::move(*content))});
  TrimCache();
  return cache_.front().content;
}

void MessageStream::TrimCache() {
  std::size_t bytes = 0;
  for (auto cached = cache_.begin(); cached != cache_.end();) {
    bytes += cached->content->records.size() +
             cached->content->entries.size() * sizeof(SegmentContent::Entry);
    cached =
        bytes > cache_bytes_ && cached != cache_.begin() ? cache_.erase(cached) : std::next(cached);
  }
}

}  // namespace isotherm::mcap
