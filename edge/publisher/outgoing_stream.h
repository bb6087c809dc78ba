#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "common/messages/frame_number_set.h"
#include "common/messages/messages.h"
#include "common/time/time_types.h"
#include "edge/publisher/flow_window.h"
#include "edge/publisher/published_stream.h"
#include "edge/publisher/publisher.h"

namespace isotherm {

/// Keeps what the publisher knows of one stream: what it has sent of the session, what of it may be
/// under way, and who reads. Thread-compatible.
class OutgoingStream {
 public:
  OutgoingStream(std::size_t flow_window_frames, Nanoseconds flow_timeout)
      : window_(flow_window_frames, flow_timeout) {}

  void BeginSession(const PublishedBefore& before) {
    counts_ = {.published = before.frames,
               .next_frame_number = std::max(before.next_frame_number, before.numbers.next())};
    published_before_ = before.next_frame_number;
    number_limit_ = before.number_limit;
    counted_before_ = before.frames - before.by_this_process;
    published_ = before.numbers;
    window_.BeginSession();
    sent_.BeginSession(std::max(before.number_limit, before.numbers.next()));
  }
  PublishedBefore so_far() const {
    return {.frames = counts_.published,
            .next_frame_number = published_before_,
            .number_limit = number_limit_,
            .numbers = published_,
            .by_this_process = counts_.published - counted_before_};
  }
  /// Enters that a frame was written. It must have been entered into sent() before the write.
  void OnPublished(std::uint64_t number) {
    ++counts_.published;
    published_.Add(number);
    window_.OnPublished(number);
    counts_.next_frame_number = std::max(counts_.next_frame_number, number + 1);
  }
  void OnFailed() { ++counts_.failed; }
  /// Enters that a frame went whole: the middleware keeps the newest of these for readers that come
  /// later.
  void OnWhole() { keeps_whole_ = true; }
  /// Enters that the middleware keeps none any more.
  void OnForgotten() { keeps_whole_ = false; }
  bool keeps_whole() const { return keeps_whole_; }
  /// Enters what the ground says, once sent() has found that it can be true.
  void OnReceipt(const StreamReceipt& receipt, SteadyTime now) {
    window_.OnReceipt(receipt.handled, now);
    if (number_limit_ == 0) return;
    // Of the processes before the ground may have more than the recording: that was published, too.
    std::uint64_t of_this = receipt.next - std::min(receipt.next, number_limit_);
    for (const FrameRange& hole : receipt.holes) {
      if (hole.last < number_limit_) continue;
      of_this -= hole.last - std::max(hole.first, number_limit_) + 1;
    }
    const std::uint64_t of_those_before = receipt.received - std::min(receipt.received, of_this);
    if (of_those_before <= counted_before_) return;
    counts_.published += of_those_before - counted_before_;
    counted_before_ = of_those_before;
  }
  /// Enters that a frame was sent from the recording. Returns whether it was the first time.
  bool OnBackfilled(std::uint64_t number) {
    if (number < published_before_ || !published_.Add(number)) return false;
    ++counts_.published;
    counts_.next_frame_number = std::max(counts_.next_frame_number, number + 1);
    return true;
  }

  /// Returns whether one of the `readers` has just come, so that its hello may still be on its way.
  bool HasNewReader(int readers, SteadyTime now) {
    if (readers > readers_) reader_came_at_ = now;
    readers_ = readers;
    return readers > 0 && now - reader_came_at_ < kHelloGrace;
  }
  /// From now on every reader counts as new: it may be the successor of one that has left.
  void ForgetReaders() { readers_ = 0; }

  /// Enters what is sent into the status of the edge.
  void FillIn(StreamStatus* status) const {
    status->published = counts_.published;
    status->next_frame_number = counts_.next_frame_number;
  }
  const StreamPublished& counts() const { return counts_; }
  FlowWindow& window() { return window_; }
  PublishedStream& sent() { return sent_; }
  const PublishedStream& sent() const { return sent_; }

 private:
  /// A ground that has just come may read before its hello is here.
  static constexpr Nanoseconds kHelloGrace = std::chrono::milliseconds(500);

  StreamPublished counts_;
  // Of the processes before that had the same session.
  std::uint64_t published_before_ = 0;  ///< Numbers below count as published.
  std::uint64_t number_limit_ = 0;      ///< All their numbers are below.
  std::uint64_t counted_before_ = 0;    ///< Their part of counts_.published.
  FrameNumberSet published_;
  FlowWindow window_;
  PublishedStream sent_;
  bool keeps_whole_ = false;     ///< The middleware keeps whole frames.
  int readers_ = 0;              ///< When last looked at.
  SteadyTime reader_came_at_{};  ///< The newest of them.
};

}  // namespace isotherm
