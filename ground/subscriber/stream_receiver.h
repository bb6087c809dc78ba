#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <optional>
#include <string_view>
#include <type_traits>
#include <vector>

#include "common/transport/refusal.h"
#include "ground/subscriber/frame_sequencer.h"
#include "ground/subscriber/frame_succession.h"
#include "ground/subscriber/received_frame.h"
#include "ground/subscriber/recorded_numbers.h"
#include "ground/subscriber/stream_tally.h"

namespace isotherm {

/// The way of one stream from the link to its consumer: session, number and payload are checked,
/// the payload is unpacked, the order is restored. A session that another one has followed does not
/// come back. Add takes a frame, DeliverDue and DeliverAll hand frames on.
///
/// A frame whose number or capture time cannot follow those before is pending: when kConfirm in a
/// row agree with each other, the stream has really jumped and goes on with them; otherwise they
/// are refused, and one wild frame stops none behind it. A replay as fast as the ground takes it
/// passes over the gaps of its recording: one more frame confirms those, and none contradicts the
/// last. ReceivedFrame is ReceivedDepth or ReceivedThermal. No DDS, no clock. Thread-compatible.
template <typename ReceivedFrame>
class StreamReceiver {
 public:
  using Encoded = std::remove_const_t<typename decltype(ReceivedFrame::encoded)::element_type>;
  using Consumer = std::function<void(ReceivedFrame)>;
  /// Frames in a row that must agree before the stream goes on elsewhere. Fewer: two wild frames
  /// that happen to fit each other move the stream; more: more of a stream that has really jumped
  /// is late. Not tuned.
  static constexpr std::size_t kConfirm = 3;
  /// Frames that are pending for longer are refused: at 1 Hz and above the frames that decide have
  /// come by then.
  static constexpr Nanoseconds kMaxPending = std::chrono::seconds(1);

  /// `refusals` are this stream's and must outlive the receiver. `deliver` gets frames in order;
  /// `deliver_late` those behind the reorder window. Empty consumers are skipped.
  StreamReceiver(std::string_view name, Nanoseconds reorder_window, RefusalCounter* refusals,
                 Consumer deliver, Consumer deliver_late);

  /// Says whether the frames of this session come as fast as the ground takes them.
  void SetReplay(bool replay) { replay_ = replay; }
  /// Enters frames of `session`, which begins by that, that an earlier process has recorded, in the
  /// order of their numbers: further copies are duplicates, the rig is told that they are here, and
  /// what comes must follow the last of them.
  void AddRecorded(std::uint64_t session, const std::vector<RecordedNumbers::Frame>& frames,
                   SteadyTime now);
  /// Takes a frame that has passed the transport's checks, and delivers none. Returns true if it
  /// was good and new.
  bool Add(Encoded&& encoded, CaptureTime arrival, SteadyTime now);
  /// Delivers what is in order or has waited long enough.
  void DeliverDue(SteadyTime now);
  /// Delivers everything that waits, in order.
  void DeliverAll();

  /// Returns when the first missing frame is given up; nullopt if no frame waits for one.
  std::optional<SteadyTime> deadline() const { return sequencer_->deadline(); }
  /// Returns how many frames are kept until others before them have come, or have confirmed them.
  std::size_t held() const { return sequencer_->waiting() + pending_.size(); }
  /// The tally of `session`, as far as it is remembered (the current one and the one before).
  StreamTally tally(std::uint64_t session) const;
  /// Returns what the edge is told of `session`; nothing but for the current one.
  StreamReceipt receipt(std::uint64_t session) const;

 private:
  using Sequencer = FrameSequencer<ReceivedFrame>;
  using ArrivalOrder = typename Sequencer::ArrivalOrder;
  static constexpr std::size_t kMaxRemembered =
      32;  ///< Sessions that must not come back; each is one start of a scan.

  bool IsCurrent(std::uint64_t session) const { return has_begun_ && session == tally_.session; }
  /// True if a frame with this header would be taken; counts it if not.
  bool IsWanted(const FrameHeader& header);
  void BeginSession(std::uint64_t session);
  void Accept(ReceivedFrame&& item, const FrameMark& mark);
  /// Makes a frame pending that `cause` speaks against. Returns true if it was accepted at once.
  bool AddPending(ReceivedFrame&& item, const FrameMark& mark, RefusalCause cause);
  /// Lets the stream go on with the pending frames.
  void AcceptPending();
  void RefusePending();
  /// Accepts or refuses the pending frames; to be called when no other frame can decide it.
  void SettlePending();
  /// Returns whether the pending frames follow a gap in a recording that is played.
  bool PendingFollowsGap() const;
  /// Delivers all that waits for its turn, and nothing that is pending.
  void Flush();
  void Refuse(RefusalCause cause, const FrameHeader& header);

  const std::string_view name_;
  RefusalCounter* const refusals_;
  const Consumer deliver_;
  const Consumer deliver_late_;
  const Nanoseconds reorder_window_;
  std::optional<Sequencer> sequencer_;  ///< Never empty; a new one for each session.
  std::optional<FrameMark> newest_;     ///< The newest of the session's frames that were taken.
  /// Holds a frame that cannot follow the newest one, until others that follow it confirm it.
  struct Pending {
    ReceivedFrame item;
    FrameMark mark;
    RefusalCause cause;
  };
  bool replay_ = false;
  bool has_begun_ = false;          ///< There is a session.
  std::vector<Pending> pending_;    ///< Each follows the one before it.
  StreamTally tally_;               ///< But for what sequencer_ and refusals_ count.
  RefusalCounts refused_before_{};  ///< When the session began.
  std::optional<StreamTally> previous_;
  std::deque<std::uint64_t> over_;  ///< The last sessions that were left.
};

extern template class StreamReceiver<ReceivedDepth>;
extern template class StreamReceiver<ReceivedThermal>;

}  // namespace isotherm
