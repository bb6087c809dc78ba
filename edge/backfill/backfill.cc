#include "edge/backfill/backfill.h"

#include <algorithm>
#include <limits>
#include <numeric>
#include <utility>
#include <variant>

#include "common/base/log.h"
#include "common/base/pause.h"
#include "common/base/status.h"
#include "common/messages/frame_number_set.h"

namespace isotherm {
namespace {

using namespace std::chrono_literals;

/// Receipts come five times a second, and with each eighth frame.
constexpr Nanoseconds kLookInterval = 20ms;
constexpr Nanoseconds kStalled = 1s;
constexpr Nanoseconds kSilent = 1s;
/// A stream of which nothing was published for this long has nothing under way.
constexpr Nanoseconds kStopped = 1s;
/// Frames that are read for one that is wanted before there is time for other things.
constexpr int kFramesPerStep = 64;
/// A file that cannot be opened so often in a row is given up.
constexpr int kMaxFailures = 10;
/// A chunk of the recording is written twice a second; before, nothing of it can be read. A file
/// that grows is opened anew each time, which takes the longer the larger it is.
constexpr Nanoseconds kRetryInterval = 1s;
constexpr Nanoseconds kBehindInterval = 100ms;
/// The reader goes on reading up to this far before what is wanted, rather than open the file anew.
constexpr Nanoseconds kReadThrough = 3s;
/// Frames are recorded in the order of their arrival; capture times of the two streams may lie so
/// far apart.
constexpr Nanoseconds kDisorder = 500ms;
/// Frames of a stream that may be published and not handled without the link being full: receipts
/// are up to 200 ms old, and the ground waits 200 ms for a missing frame.
constexpr std::uint64_t kUsuallyUnderWay = 20;

const std::vector<FrameRange> kAll = {{0, std::numeric_limits<std::uint64_t>::max()}};

std::uint64_t Frames(const std::vector<FrameRange>& ranges) {
  return std::accumulate(
      ranges.begin(), ranges.end(), std::uint64_t{0},
      [](std::uint64_t sum, const FrameRange& range) { return sum + SizeOf(range); });
}

/// Returns the part of `holes` that the ground does not wait for any more.
std::vector<FrameRange> GivenUp(const StreamReceipt& receipt) {
  std::vector<FrameRange> given_up;
  for (const FrameRange& hole : receipt.holes) {
    if (hole.first >= receipt.handled) break;
    given_up.push_back({hole.first, std::min(hole.last, receipt.handled - 1)});
  }
  return given_up;
}

/// Returns whether the ground has more holes than it tells.
bool HasMoreHoles(const StreamReceipt& receipt) {
  return receipt.holes.size() >= kMaxHoles && receipt.holes.front().first > 0;
}

/// Returns how many frames the ground has below the first hole that it tells.
std::uint64_t ReceivedBelow(const StreamReceipt& receipt) {
  const std::uint64_t from_there =
      receipt.next - receipt.holes.front().first - Frames(receipt.holes);
  return receipt.received - std::min(receipt.received, from_there);
}

/// Returns what of the frames under way cannot be said to have arrived; `missing` are the holes and
/// what is behind them.
std::vector<FrameRange> NotConfirmed(const StreamReceipt& receipt,
                                     std::vector<FrameRange> missing) {
  // Of more holes only the newest are told.
  if (HasMoreHoles(receipt)) missing.insert(missing.begin(), {0, receipt.holes.front().first - 1});
  return missing;
}

const FrameHeader& HeaderOf(const RecordedFrameReader::Frame& frame) {
  return std::visit([](const auto& content) -> const FrameHeader& { return content.header; },
                    frame);
}

Sensor SensorOf(const RecordedFrameReader::Frame& frame) {
  return std::holds_alternative<EncodedDepthFrame>(frame) ? Sensor::kDepth : Sensor::kThermal;
}

}  // namespace

Backfill::Backfill(const BackfillOptions& options, const BackfillParts& parts)
    : options_(options), parts_(parts), window_(kMaxUnderWay, options.frames_per_s) {}

void Backfill::Run(const std::stop_token& stop) {
  while (!stop.stop_requested() && !settled_) {
    progress_.Busy(parts_.clock.SteadyNow());
    const bool sent = Step(stop);
    progress_.Idle();
    if (!sent) Pause(stop, kLookInterval / 4);
  }
  reader_.Close();
}

bool Backfill::Step(const std::stop_token& stop) {
  if (settled_) return false;
  const SteadyTime now = parts_.clock.SteadyNow();
  // Asked before the receipt: what was captured last is then known when it is counted what lacks.
  const bool source_has_ended = source_ended_;
  if (now >= next_look_ || source_has_ended != is_ending_) {
    next_look_ = now + kLookInterval;
    if (const std::optional<Receipt> receipt = parts_.publisher.receipt())
      TakeReceipt(*receipt, now);
    if (!receipt_)
      CountGone(Frames(parts_.recorded.DeletedOf(Sensor::kDepth, kAll)) +
                Frames(parts_.recorded.DeletedOf(Sensor::kThermal, kAll)));
    if (source_has_ended) Settle(now);
    // A file that is deleted takes its room for as long as it is open.
    if (reader_.at() && !parts_.recorded.HasFile(reader_.at()->file)) reader_.Close();
  }
  if (!receipt_ || now < retry_at_ || !window_.MaySend(now)) return false;
  return SendNext(now, stop);
}

void Backfill::TakeReceipt(const Receipt& receipt, SteadyTime now) {
  receipt_ = receipt;
  std::uint64_t lacking = 0, gone = 0;
  // Once nothing more is captured, what does not come by itself will not come.
  is_stalled_ = is_stalled_ || (is_ending_ && now - progress_at_ > kStalled);
  for (const auto& [sensor, stream] : {std::pair(Sensor::kDepth, &receipt_->depth),
                                       std::pair(Sensor::kThermal, &receipt_->thermal)}) {
    std::vector<FrameRange> missing = stream->holes;
    // What is behind the newest that arrived may be on its way, or wait on this side.
    missing.push_back({stream->next, std::numeric_limits<std::uint64_t>::max()});
    lacking += Frames(parts_.recorded.Of(sensor, missing));
    gone += Frames(parts_.recorded.DeletedOf(sensor, missing));
    if (HasMoreHoles(*stream)) {
      const std::vector<FrameRange> below{{0, stream->holes.front().first - 1}};
      const std::uint64_t recorded = Frames(parts_.recorded.Of(sensor, below));
      const std::uint64_t deleted = Frames(parts_.recorded.DeletedOf(sensor, below));
      const std::uint64_t missed =
          recorded + deleted - std::min(recorded + deleted, ReceivedBelow(*stream));
      // Which ones is not told; the oldest are the likeliest.
      gone += std::min(deleted, missed);
      lacking += missed - std::min(deleted, missed);
    }
    NoteLost(sensor, window_.OnReceipt(sensor, NotConfirmed(*stream, missing), now));
    wanted_[static_cast<std::size_t>(sensor)] =
        parts_.recorded.Of(sensor, is_stalled_ ? missing : GivenUp(*stream));
  }
  lacking_ = lacking;
  CountGone(gone);
  arrived_ = window_.confirmed();
}

void Backfill::CountGone(std::uint64_t frames) {
  if (gone_ == 0 && frames > 0) {
    LOG(Edge, Warning) << "the recording keeps the newest only (spool.when_full=KEEP_NEWEST): "
                          "frames are deleted that the ground does not have, so far "
                       << frames;
  }
  gone_ = frames;
}

void Backfill::NoteLost(Sensor sensor, const std::vector<std::uint64_t>& frames) {
  // The ground may refuse a frame each time; links that lose a third of all lose none so often.
  constexpr int kMaxTries = 20;
  // More is a link that loses nearly all, for which each frame may be tried anew.
  constexpr std::size_t kMaxRemembered = 4096;
  std::map<std::uint64_t, int>& tries = tries_[static_cast<std::size_t>(sensor)];
  if (tries.size() > kMaxRemembered) tries.clear();
  for (const std::uint64_t number : frames) {
    if (++tries[number] < kMaxTries) continue;
    parts_.recorded.Forget(sensor, {number, number});
    tries.erase(number);
  }
}

void Backfill::Settle(SteadyTime now) {
  const std::uint64_t lacking = lacking_;
  // Where a hole is filled, an older one is told instead, so that as many may lack as before.
  const std::uint64_t received =
      receipt_ ? receipt_->depth.received + receipt_->thermal.received : 0;
  if (!std::exchange(is_ending_, true) || lacking < lacked_ || received > received_)
    progress_at_ = now;
  lacked_ = lacking;
  received_ = received;
  const PublisherStats link = parts_.publisher.stats();
  // One that never said anything is not waited for; it may be about to, if it is there.
  const bool is_awaited = receipt_ ? lacking > 0 : link.takes_backfill;
  // Patience is with a ground that is heard, and takes nothing. The middleware itself notices only
  // after ten seconds that it is not.
  const bool is_cut_off = receipt_ && link.receipt_age.value_or(kSilent) >= kSilent;
  if (is_awaited && options_.waits_for_ground && is_cut_off) progress_at_ = now;
  if (is_awaited && now - progress_at_ < options_.patience) return;
  if (is_awaited && lacking > 0) {
    LOG(Edge, Warning) << "the ground does not take what it lacks any more, frames=" << lacking
                       << "; the recording has them (isotherm merge-recordings)";
  }
  settled_ = true;
}

bool Backfill::IsWanted(Sensor sensor, std::uint64_t number) const {
  return IsIn(number, wanted_[static_cast<std::size_t>(sensor)]) &&
         !window_.IsUnderWay(sensor, number);
}

std::optional<Backfill::Target> Backfill::FindTarget() const {
  // What got lost and is wanted again is read when there is nothing ahead: going back takes time.
  const std::optional<Target> ahead = FirstWanted(/*only_ahead=*/true);
  return ahead ? ahead : FirstWanted(/*only_ahead=*/false);
}

std::optional<Backfill::Target> Backfill::FirstWanted(bool only_ahead) const {
  std::optional<Target> first;
  for (const Sensor sensor : {Sensor::kDepth, Sensor::kThermal}) {
    const std::optional<std::uint64_t>& passed = passed_[static_cast<std::size_t>(sensor)];
    if (only_ahead && !passed) continue;
    for (const FrameRange& range : wanted_[static_cast<std::size_t>(sensor)]) {
      std::uint64_t number = only_ahead ? std::max(range.first, *passed + 1) : range.first;
      // No more are under way than the window holds.
      while (number <= range.last && window_.IsUnderWay(sensor, number)) ++number;
      if (number > range.last) continue;
      const auto place = parts_.recorded.PlaceOf(sensor, number);
      if (place && (!first || place->time < first->place.time)) first = {sensor, number, *place};
      break;
    }
  }
  return first;
}

bool Backfill::GoTo(const Target& target, SteadyTime now) {
  const auto& at = reader_.at();
  const std::optional<std::uint64_t>& passed = passed_[static_cast<std::size_t>(target.sensor)];
  const bool leads_there = at && at->file == target.place.file && passed &&
                           *passed < target.number && target.place.time <= at->time + kReadThrough;
  if (leads_there) return true;
  const Status gone = reader_.GoTo({target.place.file, target.place.time - kDisorder});
  if (!gone.ok()) {
    retry_at_ = now + kRetryInterval;
    if (++failures_ < kMaxFailures) return false;
    failures_ = 0;
    LOG(Edge, Warning) << "what the ground lacks cannot be read and stays on the rig: "
                       << gone.message();
    // Of the newest file as well: the frames that follow are known again when they are recorded.
    for (const Sensor sensor : {Sensor::kDepth, Sensor::kThermal})
      parts_.recorded.ForgetAll(sensor, target.place.file);
    return false;
  }
  failures_ = 0;
  passed_ = {};
  passed_[static_cast<std::size_t>(target.sensor)] =
      target.number - std::min<std::uint64_t>(target.number, 1);
  return true;
}

void Backfill::NotePassed(Sensor sensor, std::uint64_t number) {
  std::optional<std::uint64_t>& passed = passed_[static_cast<std::size_t>(sensor)];
  if (passed && number <= *passed) return;  // Before the target.
  if (passed && number > *passed + 1) {
    for (const FrameRange& wanted : wanted_[static_cast<std::size_t>(sensor)]) {
      const FrameRange skipped{std::max(wanted.first, *passed + 1),
                               std::min(wanted.last, number - 1)};
      if (skipped.first <= skipped.last) parts_.recorded.Forget(sensor, skipped);
    }
  }
  passed = number;
}

bool Backfill::SendNext(SteadyTime now, const std::stop_token& stop) {
  const std::optional<Target> target = FindTarget();
  if (!target || !MayDisturb(now) || !GoTo(*target, now)) return false;
  for (int read = 0; read < kFramesPerStep; ++read) {
    const Result<std::optional<RecordedFrameReader::Frame>> frame = reader_.Next();
    if (!frame) continue;  // Damaged; the frames behind it are good.
    if (!*frame) {
      // The file goes on, but not on the disk yet; or it has ended before what it should have.
      parts_.recorded.ForgetRest(target->sensor, target->number, target->place.file);
      reader_.Close();
      retry_at_ = now + kRetryInterval;
      return false;
    }
    const Sensor sensor = SensorOf(**frame);
    const std::uint64_t number = HeaderOf(**frame).frame_number;
    NotePassed(sensor, number);
    if (!IsWanted(sensor, number)) continue;
    Send(**frame, now, stop);
    return true;
  }
  return false;  // Goes on from there.
}

bool Backfill::IsBehind(Sensor sensor, const StreamPublished& sent, const StreamReceipt& receipt,
                        SteadyTime now) {
  // A camera that was lost with frames under way holds nothing up.
  auto& [next, since] = newest_published_[static_cast<std::size_t>(sensor)];
  if (std::exchange(next, sent.next_frame_number) != sent.next_frame_number) since = now;
  return now - since < kStopped && next > receipt.handled + kUsuallyUnderWay;
}

bool Backfill::MayDisturb(SteadyTime now) {
  // Who reads is asked the middleware, which is too much for each frame.
  if (now < may_disturb_until_ && !parts_.is_live_behind()) return true;
  const PublisherStats link = parts_.publisher.stats();
  const bool live_is_behind =
      !source_ended_ && (parts_.is_live_behind() || link.leaves_frames ||
                         IsBehind(Sensor::kDepth, link.depth, receipt_->depth, now) ||
                         IsBehind(Sensor::kThermal, link.thermal, receipt_->thermal, now));
  if (!live_is_behind && link.takes_backfill) {
    may_disturb_until_ = now + kLookInterval;
    return true;
  }
  window_.OnLiveBehind();
  retry_at_ = now + kBehindInterval;
  return false;
}

void Backfill::Send(const RecordedFrameReader::Frame& frame, SteadyTime now,
                    const std::stop_token& stop) {
  if (!std::exchange(reported_, true)) {
    LOG(Edge, Info) << "the ground lacks frames of the recording, and is sent them: " << lacking_;
  }
  const Sensor sensor = SensorOf(frame);
  // Entered first: a frame that the link refuses is tried again after kLostAfter, not at once.
  const std::uint64_t number = HeaderOf(frame).frame_number;
  window_.OnSent(sensor, number, now);
  const auto& tries = tries_[static_cast<std::size_t>(sensor)];
  const auto tried = tries.find(number);
  const Result<bool> sent = std::visit(
      [&](const auto& content) {
        return parts_.publisher.Backfill(content, tried == tries.end() ? 0 : tried->second, stop);
      },
      frame);
  window_.OnLeft(sensor, number, parts_.clock.SteadyNow());
  if (sent && *sent) parts_.counters.CountPublishedAfterAll(sensor);
}

}  // namespace isotherm
