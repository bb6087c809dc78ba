#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>

#include "common/time/time_types.h"

namespace isotherm {

/// Notices a link over which whole frames do not get along (lossless policy): so much of them is
/// lost, and so far away, that repairs hold up what comes after, although receipts keep coming. An
/// outage is no such link, nor is what is repaired after it; nor is a computer that is too busy to
/// take packets from its network. Bytes that are sent again count whichever reader they are for;
/// whether frames are late is the served ground's word. Pure: time enters through arguments.
/// Thread-compatible.
class RepairWatch {
 public:
  /// This fraction of the bytes is sent again at most. With 1 % of the packets lost and a round
  /// trip of 40 ms the middleware keeps up, with 5 % it does not (docs/link.md).
  static constexpr double kMaxRepeated = 0.02;
  /// Less than this is a lost packet or two, whatever was sent meanwhile.
  static constexpr std::uint64_t kMinRepeatedBytes = 10'000;
  /// There and back takes a frame and its receipt this long at the quickest: repairs take as long.
  /// Nearer, the middleware repairs a fifth in time. The ground's receipts wait for a few frames,
  /// so that a rig of less than 20 frames a second seems farther than it is. Not tuned.
  static constexpr Nanoseconds kFar = std::chrono::milliseconds(30);
  /// Bytes are compared over this time, and frames are late for as long. Not tuned.
  static constexpr Nanoseconds kOver = std::chrono::seconds(1);
  /// Receipts come five times a second, and lost ones are repaired; longer than this without one is
  /// an outage.
  static constexpr Nanoseconds kSilence = std::chrono::milliseconds(800);
  /// An outage's remains have been repaired by then on a link that is good otherwise.
  static constexpr Nanoseconds kAfterSilence = std::chrono::seconds(3);

  void BeginSession() { *this = RepairWatch(); }

  /// Enters that a receipt came: of a ground that was there when the first frame was sent, or that
  /// has found this rig since and has to be sent first what was kept for it.
  void OnReceipt(SteadyTime now) {
    const auto heard_at = receipt_at_ ? receipt_at_ : first_sent_at_;
    if (heard_at && now - *heard_at > kSilence) silence_ended_ = now;
    receipt_at_ = now;
  }

  /// Enters a frame that was sent for the first time.
  void OnSent(std::size_t bytes, SteadyTime now) {
    sent_bytes_ += bytes;
    if (!first_sent_at_) first_sent_at_ = now;
  }

  /// Takes in how many bytes have been sent again so far, how long a frame and its receipt took at
  /// the quickest, and whether frames are under way for much longer. Returns whether the link is
  /// such a one. To be called several times within kOver.
  bool Look(std::uint64_t repeated_bytes, Nanoseconds quickest, bool is_late, SteadyTime now) {
    while (looks_.size() > 1 && now - looks_[1].time >= kOver) looks_.pop_front();
    looks_.push_back({now, sent_bytes_, repeated_bytes});
    const bool was_silent = !receipt_at_ || now - *receipt_at_ > kSilence ||
                            (silence_ended_ && now - *silence_ended_ < kAfterSilence);
    if (!is_late || was_silent) late_since_.reset();
    if (!is_late || was_silent || quickest < kFar) return false;
    if (!late_since_) late_since_ = now;
    return now - *late_since_ >= kOver && RepeatsTooMuch();
  }

 private:
  /// Holds what one look showed.
  struct Observation {
    SteadyTime time;
    std::uint64_t sent_bytes, repeated_bytes;
  };

  bool RepeatsTooMuch() const {
    const Observation &first = looks_.front(), &last = looks_.back();
    // The count begins anew with a writer that is made anew.
    if (last.repeated_bytes < first.repeated_bytes + kMinRepeatedBytes) return false;
    const auto sent = static_cast<double>(last.sent_bytes - first.sent_bytes);
    return static_cast<double>(last.repeated_bytes - first.repeated_bytes) > kMaxRepeated * sent;
  }

  std::uint64_t sent_bytes_ = 0;
  std::deque<Observation> looks_;  ///< The newest kOver, and one before.
  std::optional<SteadyTime> first_sent_at_, receipt_at_, silence_ended_;
  std::optional<SteadyTime> late_since_;  ///< Without a break, and not by an outage.
};

}  // namespace isotherm
