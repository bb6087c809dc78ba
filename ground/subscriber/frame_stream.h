#pragma once

#include <algorithm>
#include <cstdint>
#include <deque>
#include <optional>
#include <utility>

#include "common/frame/frame.h"
#include "common/transport/refusal.h"
#include "ground/subscriber/frame_sequencer.h"

namespace isotherm {

/// Holds what one stream has received of one session.
struct StreamTally {
  std::uint64_t session = 0;
  std::uint64_t next = 0;  ///< One above the highest number.
  std::uint64_t received = 0;
  std::uint64_t late = 0;
  std::uint64_t duplicates = 0;
  RefusalCounts refused{};  ///< Samples since the session began, by cause.
};

/// One stream over its sessions: a FrameSequencer for the newest session, and the tally of the one
/// before. A session that was left does not come back. Pure. Thread-compatible.
template <typename T>
class FrameStream {
 public:
  using Sequencer = FrameSequencer<T>;
  using Verdict = typename Sequencer::Verdict;

  explicit FrameStream(Nanoseconds window) : window_(window), sequencer_(std::in_place, window) {}

  enum class Session { kCurrent, kNew, kOver };
  Session Classify(std::uint64_t session) const {
    if (started_ && session == tally_.session) return Session::kCurrent;
    return std::ranges::find(over_, session) == over_.end() ? Session::kNew : Session::kOver;
  }

  /// Leaves the current session for `session`. What still waits is dropped: Flush() before.
  void BeginSession(std::uint64_t session) {
    if (started_) {
      previous_ = tally();
      over_.push_back(tally_.session);
      if (over_.size() > kMaxRemembered) over_.pop_front();
    }
    started_ = true;
    tally_ = {};
    tally_.session = session;
    sequencer_.emplace(window_);
  }

  /// Returns what would become of a frame of the current session.
  Verdict Check(std::uint64_t number) const { return sequencer_->Check(number); }

  /// Takes a frame of the current session as FrameSequencer::Add does, and counts it.
  Verdict Add(std::uint64_t number, T&& item, SteadyTime now) {
    const Verdict verdict = sequencer_->Add(number, std::move(item), now);
    if (verdict == Verdict::kLate) ++tally_.late;
    return verdict;
  }
  void CountDuplicate() { ++tally_.duplicates; }

  std::optional<T> Next(SteadyTime now) { return sequencer_->Next(now); }
  std::optional<T> Flush() { return sequencer_->Flush(); }
  void Resync(std::uint64_t number) { sequencer_->Resync(number); }
  std::optional<SteadyTime> deadline() const { return sequencer_->deadline(); }

  /// The tally of the current session.
  StreamTally tally() const {
    StreamTally tally = tally_;
    tally.next = sequencer_->receipts().next();
    tally.received = sequencer_->receipts().received();
    return tally;
  }
  /// The tally of `session`, as far as it is remembered (the current one and the one before).
  StreamTally tally(std::uint64_t session) const {
    if (started_ && session == tally_.session) return tally();
    if (previous_ && session == previous_->session) return *previous_;
    StreamTally empty;
    empty.session = session;
    return empty;
  }
  StreamReceipt receipt(std::uint64_t session) const {
    if (!started_ || session != tally_.session) return {};
    const ReceiptTracker& receipts = sequencer_->receipts();
    return {.next = receipts.next(),
            .handled = sequencer_->handled(),
            .received = receipts.received(),
            .holes = receipts.NewestHoles(kMaxHoles)};
  }

 private:
  static constexpr std::size_t kMaxRemembered = 32;  ///< Sessions that must not come back.

  const Nanoseconds window_;
  std::optional<Sequencer> sequencer_;
  bool started_ = false;
  StreamTally tally_;
  std::optional<StreamTally> previous_;
  std::deque<std::uint64_t> over_;
};

}  // namespace isotherm
