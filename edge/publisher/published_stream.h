#pragma once

#include <algorithm>
#include <cstdint>
#include <deque>
#include <optional>

#include "common/messages/messages.h"
#include "common/time/time_types.h"
#include "common/transport/refusal.h"

namespace isotherm {

/// Holds what was published of one stream in the present session, to assess what the ground says of
/// it. Pure. Thread-compatible.
class PublishedStream {
 public:
  /// Another process may have published each of the numbers below `number_limit`.
  void BeginSession(std::uint64_t number_limit) {
    *this = {};
    next_ = count_ = number_limit;
  }

  /// To be called before the frame is written: the ground may answer before writing returns.
  void Note(std::uint64_t frame_number, CaptureTime capture_time) {
    next_ = std::max(next_, frame_number + 1);
    ++count_;
    newest_.push_back({frame_number, capture_time});
    if (newest_.size() > kRemembered) newest_.pop_front();
  }

  /// To be called before a frame is written that the ground lacks, whether it was sent before or
  /// not.
  void NoteAgain(std::uint64_t frame_number) {
    next_ = std::max(next_, frame_number + 1);
    ++count_;
    const auto found = Find(frame_number);
    if (found != newest_.end()) found->again = true;
  }

  /// Returns whether a frame of the newest was sent again, some time after it was new.
  bool WasSentAgain(std::uint64_t frame_number) const {
    const auto found = Find(frame_number);
    return found != newest_.end() && found->again;
  }

  /// Says why the receipt cannot be true: more than was published cannot have been received.
  std::optional<RefusalCause> Check(const StreamReceipt& receipt) const {
    if (receipt.next <= next_ && receipt.received <= count_) return std::nullopt;
    return RefusalCause::kImpossibleNumber;
  }
  /// Says why the feedback cannot be true: it must be about a frame that was published not long
  /// ago, and know its capture time.
  std::optional<RefusalCause> Check(const Feedback& feedback) const {
    if (feedback.frame_number >= next_) return RefusalCause::kImpossibleNumber;
    const auto found = Find(feedback.frame_number);
    if (found == newest_.end()) return RefusalCause::kImpossibleNumber;
    if (found->capture_time != feedback.capture_time) return RefusalCause::kOutOfRange;
    return std::nullopt;
  }

 private:
  static constexpr std::size_t kRemembered = 1024;  ///< Half a minute.

  /// Holds a published frame's number and time, which feedback must repeat.
  struct Frame {
    std::uint64_t number = 0;
    CaptureTime capture_time{};
    bool again = false;
  };

  template <typename Frames>
  static auto FindIn(Frames& frames, std::uint64_t number) {
    const auto found = std::ranges::lower_bound(frames, number, {}, &Frame::number);
    return found == frames.end() || found->number != number ? frames.end() : found;
  }
  std::deque<Frame>::const_iterator Find(std::uint64_t number) const {
    return FindIn(newest_, number);
  }
  std::deque<Frame>::iterator Find(std::uint64_t number) { return FindIn(newest_, number); }

  std::uint64_t next_ = 0;    ///< One above the highest number.
  std::uint64_t count_ = 0;   ///< Frames that were sent, each time.
  std::deque<Frame> newest_;  ///< Ascending.
};

}  // namespace isotherm
