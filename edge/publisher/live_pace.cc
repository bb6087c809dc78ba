#include "edge/publisher/live_pace.h"

#include <algorithm>

#include "common/messages/frame_number_set.h"

namespace isotherm {
namespace {

/// More than the middleware's history.
constexpr std::size_t kMaxUnderWay = 256;
/// Frames of a stream that may be under way for so long after the first one has arrived. A ground
/// that is new to the scan sends a receipt for each frame then.
constexpr std::size_t kFirstFrames = 4;
constexpr Nanoseconds kUnprovenFor = std::chrono::seconds(3);
/// A delay so soon after a step back is that step's.
constexpr Nanoseconds kTooSoon = std::chrono::seconds(10);
/// The quickest frame of this long counts; of the two newest such times.
constexpr Nanoseconds kQuickestFor = std::chrono::seconds(30);

}  // namespace

bool LivePace::TakesNext(Sensor sensor, SteadyTime now) {
  is_asked_ = true;
  Stream& stream = Of(sensor);
  if (IsStalled(now) || IsUnproven(stream, now)) {
    if (now - stream.sent_at < kProbeInterval) return false;
    stream.waiting = 0;
    return true;
  }
  if (++stream.waiting < stride(sensor)) return false;
  stream.waiting = 0;
  return true;
}

void LivePace::OnSent(Sensor sensor, std::uint64_t number, SteadyTime now) {
  Stream& stream = Of(sensor);
  stream.sent_at = now;
  stream.under_way.push_back({number, now});
  // Without receipts it is enough to know the newest.
  if (stream.under_way.size() > kMaxUnderWay) stream.under_way.pop_front();
}

void LivePace::OnReceipt(const Receipt& receipt, SteadyTime now) {
  const bool after_silence = !receipt_at_ || now - *receipt_at_ > kStalledDelay;
  receipt_at_ = now;
  TakeOut(Of(Sensor::kDepth), receipt.depth, now);
  TakeOut(Of(Sensor::kThermal), receipt.thermal, now);
  // After an outage there is a backlog whose size says nothing of the link's rate.
  if (after_silence) changed_at_ = clear_since_ = now;
  Decide(now);
}

void LivePace::TakeOut(Stream& stream, const StreamReceipt& receipt, SteadyTime now) {
  std::optional<SteadyTime> newest;
  std::erase_if(stream.under_way, [&](const Sent& sent) {
    const bool is_there = sent.number < receipt.next && !IsIn(sent.number, receipt.holes);
    if (is_there) newest = sent.time;
    return is_there || sent.number < receipt.handled;
  });
  if (!newest) return;
  stream.arrived = newest;
  NoteQuickest(now - *newest, now);
}

void LivePace::NoteQuickest(Nanoseconds took, SteadyTime now) {
  if (!first_arrival_) first_arrival_ = now;
  if (now - quickest_since_ > kQuickestFor) {
    quickest_[1] = quickest_[0];
    quickest_[0] = took;
    quickest_since_ = now;
  }
  quickest_[0] = std::min(quickest_[0], took);
}

Nanoseconds LivePace::Delay(SteadyTime now) const {
  Nanoseconds longest{};
  for (std::size_t i = 0; i < streams_.size(); ++i) {
    if (streams_.at(i).under_way.empty()) continue;
    const SteadyTime oldest = streams_.at(i).under_way.front().time;
    // The last frame of a camera that is gone, or frames that the ground refuses: what was sent of
    // the other stream long after that is there.
    const std::optional<SteadyTime>& other = streams_.at(1 - i).arrived;
    if (other && *other > oldest + kStalledDelay) continue;
    longest = std::max(longest, Nanoseconds(now - oldest));
  }
  return longest - std::min(longest, std::min(quickest_[0], quickest_[1]));
}

bool LivePace::IsStalled(SteadyTime now) const {
  // A ground that sends no receipts at all says nothing of the link.
  return receipt_at_ && Delay(now) > kStalledDelay;
}

bool LivePace::IsUnproven(const Stream& stream, SteadyTime now) const {
  if (!receipt_at_ || stream.under_way.size() < kFirstFrames) return false;
  return !first_arrival_ || now - *first_arrival_ < kUnprovenFor;
}

void LivePace::Decide(SteadyTime now) {
  const Nanoseconds delay = Delay(now);
  if (delay > kFullDelay / 2) clear_since_ = now;
  if (delay > kFullDelay) {
    // What was changed shows when what was sent before has arrived.
    if (now - changed_at_ < std::clamp(delay, kFullDelay, kStalledDelay)) return;
    if (went_back_ && now - changed_at_ < kTooSoon) hold_ = std::min(2 * hold_, kMaxHold);
    if (step_ + 1 < kSteps.size()) Change(step_ + 1, now);
  } else if (step_ > 0 && now - clear_since_ > hold_) {
    Change(step_ - 1, now);
  } else if (step_ == 0 && now - clear_since_ > kMaxHold) {
    hold_ = kFirstHold;
  }
}

void LivePace::Change(std::size_t step, SteadyTime now) {
  went_back_ = step < step_;
  step_ = step;
  changed_at_ = clear_since_ = now;
}

}  // namespace isotherm
