#include "ground/subscriber/stream_receiver.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "common/base/log.h"
#include "common/codec/codec.h"

namespace isotherm {
namespace {

Result<Image<std::uint16_t>> PixelsOf(const EncodedDepthFrame& encoded) {
  return Decode(encoded.image, kMaxFramePixels);
}

Result<Image<std::uint16_t>> PixelsOf(const EncodedThermalFrame& encoded) {
  return DecodeTemperatures(encoded.image, kMaxFramePixels);
}

ReceivedDepth Unpacked(EncodedDepthFrame&& encoded, Image<std::uint16_t>&& pixels,
                       CaptureTime arrival) {
  auto frame = std::make_shared<DepthFrame>();
  frame->header = encoded.header;
  frame->depth_raw = std::move(pixels);
  frame->depth_scale = encoded.depth_scale;
  return {.frame = std::move(frame),
          .encoded = std::make_shared<const EncodedDepthFrame>(std::move(encoded)),
          .arrival = arrival};
}

ReceivedThermal Unpacked(EncodedThermalFrame&& encoded, Image<std::uint16_t>&& pixels,
                         CaptureTime arrival) {
  auto frame = std::make_shared<ThermalFrame>();
  frame->header = encoded.header;
  frame->temperature_raw = std::move(pixels);
  frame->scale = encoded.scale;
  frame->nuc_state = encoded.nuc_state;
  frame->nuc_source = encoded.nuc_source;
  frame->seconds_since_nuc = encoded.seconds_since_nuc;
  frame->housekeeping = encoded.housekeeping;
  // Counts are no temperatures, whatever the edge says of them.
  frame->valid = encoded.valid && encoded.image.encoding != Encoding::kCounts16;
  return {.frame = std::move(frame),
          .encoded = std::make_shared<const EncodedThermalFrame>(std::move(encoded)),
          .arrival = arrival};
}

}  // namespace

template <typename ReceivedFrame>
StreamReceiver<ReceivedFrame>::StreamReceiver(std::string_view name, Nanoseconds reorder_window,
                                              RefusalCounter* refusals, Consumer deliver,
                                              Consumer deliver_late)
    : name_(name),
      refusals_(refusals),
      deliver_(std::move(deliver)),
      deliver_late_(std::move(deliver_late)),
      reorder_window_(reorder_window),
      sequencer_(std::in_place, reorder_window) {}

template <typename ReceivedFrame>
bool StreamReceiver<ReceivedFrame>::IsWanted(const FrameHeader& header) {
  if (!IsCurrent(header.session)) {
    const bool is_new = std::ranges::find(over_, header.session) == over_.end();
    // A late frame of a session that was left must not end the one that has followed it.
    if (!is_new) Refuse(RefusalCause::kOtherSession, header);
    return is_new;
  }
  if (sequencer_->Check(header.frame_number) != ArrivalOrder::kDuplicate) return true;
  ++tally_.duplicates;
  return false;
}

template <typename ReceivedFrame>
void StreamReceiver<ReceivedFrame>::AddRecorded(std::uint64_t session,
                                                const std::vector<RecordedNumbers::Frame>& frames,
                                                SteadyTime now) {
  if (std::ranges::find(over_, session) != over_.end()) return;
  if (!IsCurrent(session)) BeginSession(session);
  for (const auto& [number, time] : frames) {
    tally_.recorded_before += sequencer_->AddKnown(number) ? 1 : 0;
    if (!newest_ || number > newest_->number) newest_ = FrameMark{number, time, now};
  }
}

template <typename ReceivedFrame>
bool StreamReceiver<ReceivedFrame>::Add(Encoded&& encoded, CaptureTime arrival, SteadyTime now) {
  const FrameHeader header = encoded.header;
  if (!IsWanted(header)) return false;
  // Unpacked before it is known whether the frame can follow: one that cannot be unpacked must
  // neither begin a session nor count as one of those that confirm a jump.
  Result<Image<std::uint16_t>> pixels = PixelsOf(encoded);
  if (!pixels) {
    Refuse(RefusalCause::kUndecodable, header);
    return false;
  }
  if (!IsCurrent(header.session)) {
    BeginSession(header.session);
    LOG(Subscriber, Info) << "first " << name_ << " frame, session=" << header.session
                          << " frame_number=" << header.frame_number;
  }
  const FrameMark mark{header.frame_number, header.capture_time, now};
  ReceivedFrame item = Unpacked(std::move(encoded), std::move(*pixels), arrival);
  if (newest_) {
    if (const auto cause = CheckFollows(*newest_, mark)) {
      return AddPending(std::move(item), mark, *cause);
    }
  }
  // A frame that follows those before proves the pending ones wrong: they said that the stream had
  // jumped away. One that fills a hole proves nothing.
  if (!newest_ || mark.number > newest_->number) RefusePending();
  Accept(std::move(item), mark);
  return true;
}

template <typename ReceivedFrame>
void StreamReceiver<ReceivedFrame>::BeginSession(std::uint64_t session) {
  DeliverAll();
  if (std::exchange(has_begun_, true)) {
    // The old session's tally is still asked for, until its end is reported.
    previous_ = tally(tally_.session);
    refused_before_ = refusals_->counts();
    over_.push_back(tally_.session);
    if (over_.size() > kMaxRemembered) over_.pop_front();
  }
  newest_.reset();
  tally_ = {};
  tally_.session = session;
  sequencer_.emplace(reorder_window_);
}

template <typename ReceivedFrame>
void StreamReceiver<ReceivedFrame>::Accept(ReceivedFrame&& item, const FrameMark& mark) {
  // A frame that fills a hole is not the newest: later ones are compared with the highest number.
  if (!newest_ || mark.number > newest_->number) newest_ = mark;
  if (sequencer_->Add(mark.number, std::move(item), mark.arrival) != ArrivalOrder::kLate) return;
  ++tally_.late;
  // Add has left it where it was.
  item.is_late = true;                                // NOLINT(bugprone-use-after-move)
  if (deliver_late_) deliver_late_(std::move(item));  // NOLINT(bugprone-use-after-move)
}

template <typename ReceivedFrame>
bool StreamReceiver<ReceivedFrame>::AddPending(ReceivedFrame&& item, const FrameMark& mark,
                                               RefusalCause cause) {
  // Of a replay one more frame is enough: recordings have gaps where frames were dropped, and
  // nothing else explains two frames that agree with the recording's own times.
  if (PendingFollowsGap() && MayFollowGap(pending_.back().mark, mark, item.arrival)) {
    AcceptPending();
    if (!CheckFollows(*newest_, mark)) {
      Accept(std::move(item), mark);
      return true;
    }
  } else if (!pending_.empty()) {
    const FrameMark& last = pending_.back().mark;
    // Pending frames must agree among themselves; a frame that does not begins the count anew.
    if (mark.number <= last.number || CheckFollows(last, mark)) RefusePending();
  }
  pending_.push_back({std::move(item), mark, cause});
  if (pending_.size() < kConfirm) return false;
  AcceptPending();
  return true;
}

template <typename ReceivedFrame>
bool StreamReceiver<ReceivedFrame>::PendingFollowsGap() const {
  return replay_ && newest_ && !pending_.empty() &&
         MayFollowGap(*newest_, pending_.front().mark, pending_.front().item.arrival);
}

template <typename ReceivedFrame>
void StreamReceiver<ReceivedFrame>::AcceptPending() {
  const bool gap = PendingFollowsGap();
  std::vector<Pending> accepted = std::exchange(pending_, {});
  const FrameMark& first = accepted.front().mark;
  const double advance_s = ToSeconds(first.time - newest_->time);
  if (gap) {
    LOG(Subscriber, Info) << "the recording that is played has a gap in its " << name_
                          << " stream, frame_number=" << first.number << " gap_s=" << advance_s;
  } else {
    LOG(Subscriber, Warning) << "the " << name_
                             << " stream has jumped, from frame_number=" << newest_->number
                             << " to " << first.number << ", capture time by " << advance_s
                             << " s; it goes on there: look at the clocks of rig and camera";
  }
  Flush();
  // Numbers before the jump will not come any more: without this the sequencer would wait for each
  // of them, or call the new ones late.
  sequencer_->Resync(first.number);
  newest_.reset();
  for (Pending& next : accepted) Accept(std::move(next.item), next.mark);
}

template <typename ReceivedFrame>
void StreamReceiver<ReceivedFrame>::SettlePending() {
  // Nothing will come that could contradict them, and a gap is the likelier explanation of what a
  // recording holds.
  if (PendingFollowsGap()) return AcceptPending();
  RefusePending();
}

template <typename ReceivedFrame>
void StreamReceiver<ReceivedFrame>::RefusePending() {
  for (const Pending& pending : pending_) Refuse(pending.cause, pending.item.frame->header);
  pending_.clear();
}

template <typename ReceivedFrame>
StreamTally StreamReceiver<ReceivedFrame>::tally(std::uint64_t session) const {
  if (!IsCurrent(session)) {
    StreamTally unknown;
    unknown.session = session;
    return previous_ && previous_->session == session ? *previous_ : unknown;
  }
  StreamTally tally = tally_;
  tally.next = sequencer_->receipts().next();
  tally.received = sequencer_->receipts().size();
  tally.refused = refusals_->counts();
  // The counter runs over all sessions; the tally is of this one.
  for (std::size_t i = 0; i < tally.refused.size(); ++i) tally.refused[i] -= refused_before_[i];
  return tally;
}

template <typename ReceivedFrame>
StreamReceipt StreamReceiver<ReceivedFrame>::receipt(std::uint64_t session) const {
  if (!IsCurrent(session)) return {};
  const FrameNumberSet& receipts = sequencer_->receipts();
  return {.next = receipts.next(),
          .handled = sequencer_->handled(),
          .received = receipts.size(),
          .holes = receipts.NewestHoles(kMaxHoles)};
}

template <typename ReceivedFrame>
void StreamReceiver<ReceivedFrame>::DeliverDue(SteadyTime now) {
  // A stream that stops while frames are pending would keep them, and its counts open, for ever.
  if (!pending_.empty() && now >= pending_.front().mark.arrival + kMaxPending) SettlePending();
  while (std::optional<ReceivedFrame> item = sequencer_->Next(now)) {
    if (deliver_) deliver_(std::move(*item));
  }
}

template <typename ReceivedFrame>
void StreamReceiver<ReceivedFrame>::DeliverAll() {
  SettlePending();
  Flush();
}

template <typename ReceivedFrame>
void StreamReceiver<ReceivedFrame>::Flush() {
  while (std::optional<ReceivedFrame> item = sequencer_->Flush()) {
    if (deliver_) deliver_(std::move(*item));
  }
}

template <typename ReceivedFrame>
void StreamReceiver<ReceivedFrame>::Refuse(RefusalCause cause, const FrameHeader& header) {
  refusals_->Add(cause, fmt::format("stream={} session={} frame_number={}", name_, header.session,
                                    header.frame_number));
}

template class StreamReceiver<ReceivedDepth>;
template class StreamReceiver<ReceivedThermal>;

}  // namespace isotherm
