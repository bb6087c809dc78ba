#include "edge/publisher/dds_publisher.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "common/base/log.h"
#include "common/transport/poll_interval.h"
#include "common/transport/qos.h"

namespace isotherm {
namespace {

using namespace std::chrono_literals;

constexpr Nanoseconds kPresenceInterval = 100ms;  ///< To look whether the ground is there.

Sensor SensorOf(const EncodedDepthFrame&) { return Sensor::kDepth; }
Sensor SensorOf(const EncodedThermalFrame&) { return Sensor::kThermal; }

/// A frame that got lost more often than parity explains is sent reliably, however long it takes.
constexpr int kTriesInPieces = 3;
/// So long after the last piece a receipt says what arrived for good: more than a round trip and
/// the interval of receipts.
constexpr Nanoseconds kPiecesUnderWay = 1s;

Status NoTimeLeft() { return Unavailable("not sent: told to stop, and the link is too slow"); }

}  // namespace

Status DdsPublisher::Open(const Participant& participant) {
  ISOTHERM_RETURN_IF_ERROR(ends_.Open(participant, refusals_));
  return ends_.hello.Write(options_.edge_id, own_hello_);
}

void DdsPublisher::Run(std::stop_token stop, const PublisherHandlers& handlers) {
  const std::stop_callback wake(stop, [this] { ends_.wait_set.Wake(); });
  while (!stop.stop_requested()) {
    ends_.wait_set.Wait(kPresenceInterval);
    ends_.peers.Take([&](Received<Hello>&& peer) { OnPeer(peer); });
    TakeReceipts();
    ends_.piece_reports.Take([&](Received<PieceReport>&& report) {
      if (IsOurs(report.edge_id)) OnPieceReport(report);
    });
    ends_.feedback.Take([&](Received<Feedback>&& feedback) {
      if (IsOurs(feedback.edge_id)) OnFeedback(feedback, handlers);
    });
    ends_.commands.Take([&](Received<Command>&& command) {
      if (handlers.command && IsOurs(command.edge_id)) handlers.command(command.message);
    });
    LookForGround();
  }
}

void DdsPublisher::TakeReceipts() {
  MutexLock lock(receipts_mutex_);
  ends_.receipts.Take([&](Received<Receipt>&& receipt)
                          REQUIRES(receipts_mutex_) { OnReceipt(receipt); });
}

void DdsPublisher::OnPeer(const Received<Hello>& peer) {
  if (peer.message.role != Role::kGround) return;
  const Status compatible = CheckCompatible(own_hello_, peer.message);
  if (!compatible.ok()) refusals_.Add(RefusalCause::kOtherVersion, compatible.message());
  const PeerHandle process = ends_.peers.PeerOf(peer.writer);
  MutexLock lock(mutex_);
  if (!compatible.ok()) return grounds_.AddStranger(process);
  grounds_.Add(peer.writer, process);
}

void DdsPublisher::OnReceipt(const Received<Receipt>& received) {
  const Receipt& receipt = received.message;
  const ClockEcho echo{.ping = receipt.clock_ping, .received = clock_.Now()};
  const SteadyTime now = clock_.SteadyNow();
  const PeerHandle sender = ends_.receipts.PeerOf(received.writer);
  MutexLock lock(mutex_);
  const bool ours = IsOurs(received.edge_id);
  const bool accepted = receipt.verdict == SessionVerdict::kFollowed;
  const bool from_ground = grounds_.OnReceipt(sender, received.edge_id, receipt, session_, now);
  if (!ours) return;
  std::optional<RefusalCause> cause;
  if (!from_ground) {
    cause = RefusalCause::kNotTheGround;
  } else if (session_ == receipt.session) {
    cause = RefusalOf(receipt);
  }
  if (cause) {
    lock.unlock();
    refusals_.Add(
        *cause, fmt::format("topic={} depth.next={} thermal.next={}", TopicName(TopicId::kReceipt),
                            receipt.depth.next, receipt.thermal.next));
    return;
  }
  if (echo.ping != 0) clock_echo_ = echo;
  if (session_ == receipt.session && accepted && grounds_.AdmitReceipt(sender, now)) {
    receipt_.Set(receipt);
    receipt_at_ = now;
    depth_.OnReceipt(receipt.depth, now);
    thermal_.OnReceipt(receipt.thermal, now);
    pace_.OnReceipt(receipt, now);
    repairs_.OnReceipt(now);
    arrival_.OnReceipt(sender, receipt, now);
  }
  changed_.notify_all();
}

void DdsPublisher::OnPieceReport(const Received<PieceReport>& received) {
  const PeerHandle sender = ends_.piece_reports.PeerOf(received.writer);
  {
    MutexLock lock(mutex_);
    if (!grounds_.IsServed(sender) || received.message.session != session_) return;
  }
  if (const auto cause = pieces_.OnReport(sender, received.message)) {
    refusals_.Add(*cause, TopicName(TopicId::kPieceReport));
  }
}

void DdsPublisher::OnFeedback(const Received<Feedback>& received,
                              const PublisherHandlers& handlers) {
  const Feedback& feedback = received.message;
  const PeerHandle sender = ends_.feedback.PeerOf(received.writer);
  std::optional<RefusalCause> cause;
  bool is_live = false;
  {
    MutexLock lock(mutex_);
    cause = RefusalOf(feedback, sender);
    if (!cause && !grounds_.IsServed(sender)) return;  // One hand cannot follow two.
    is_live = !depth_.sent().WasSentAgain(feedback.frame_number);
  }
  if (cause) {
    refusals_.Add(*cause,
                  fmt::format("topic={} session={} frame_number={}", TopicName(TopicId::kFeedback),
                              feedback.session, feedback.frame_number));
  } else if (handlers.feedback) {
    handlers.feedback(feedback, clock_.Now(), is_live);
  }
}

void DdsPublisher::LookForGround() {
  const SteadyTime now = clock_.SteadyNow();
  if (now >= ways_due_) LookAtWays(now);
  MutexLock lock(mutex_);
  // After one ground has left, the next may have another version, and other readers.
  const bool left = grounds_.Look(
      now, [this](std::uint64_t hello_writer) { return ends_.peers.PeerOf(hello_writer) != 0; });
  if (!left) return;
  depth_.ForgetReaders();
  thermal_.ForgetReaders();
}

void DdsPublisher::LookAtWays(SteadyTime now) {
  ways_due_ = now + kPresenceInterval;
  const std::map<PeerHandle, Announcement> announced = ends_.announced.Of(Role::kGround);
  MutexLock lock(mutex_);
  const bool sent_pieces = SendsPieces();
  reads_pieces_ =
      grounds_.HasFollower([this](PeerHandle peer) { return ends_.pieces.Reaches(peer); });
  LookAtRepairs(now);
  if (SendsPieces() && !sent_pieces) {
    LOG(Publisher, Info) << (is_link_poor_ ? "the link loses too much for whole frames: " : "")
                         << "frames go in pieces, with parity";
  }
  const bool has_room = depth_.window().HasRoom() && thermal_.window().HasRoom();
  arrival_.Look({depth_.counts().next_frame_number, thermal_.counts().next_frame_number},
                WaitsForGround() && !has_room, now);
  grounds_.LookAtWays(now, announced, arrival_.unheard_by());
}

void DdsPublisher::LookAtRepairs(SteadyTime now) {
  if (!options_.pieces || !options_.leaves_whole_frames) return;
  const bool is_poor = repairs_.Look(ends_.depth.repeated_bytes() + ends_.thermal.repeated_bytes(),
                                     pace_.quickest(), pace_.is_late(now), now);
  if (!is_poor || !reads_pieces_ || !WaitsForGround()) return;
  is_link_poor_ = true;
}

bool DdsPublisher::IsGroundReady() const {
  MutexLock lock(mutex_);
  return grounds_.HasFollower(
      [this](PeerHandle peer) { return ends_.depth.Reaches(peer) && ends_.thermal.Reaches(peer); });
}

bool DdsPublisher::WaitForGround(Nanoseconds timeout, std::stop_token stop) {
  const SteadyTime deadline = clock_.SteadyNow() + timeout;
  while (!IsGroundReady()) {
    if (stop.stop_requested() || clock_.SteadyNow() >= deadline) return false;
    MutexLock lock(mutex_);
    changed_.wait_for(lock, kPollInterval);
  }
  return true;
}

Status DdsPublisher::BeginSession(const RigDescription& rig, const SessionBefore& before) {
  {
    MutexLock lock(mutex_);
    session_ = rig.session;
    depth_.BeginSession(before.depth);
    thermal_.BeginSession(before.thermal);
    pace_.BeginSession();
    repairs_.BeginSession();
    is_link_poor_ = false;
    pieces_.BeginSession();
    arrival_.BeginSession();
    flow_waits_ = flow_timeouts_ = 0;
    receipt_at_.reset();
  }
  receipt_.Take();  // Of the session before.
  return Announce(rig);
}

Status DdsPublisher::Announce(const RigDescription& rig) {
  return ends_.rig.Write(options_.edge_id, rig);
}

bool DdsPublisher::TakesNext(Sensor sensor, std::size_t newer) {
  if (WaitsForGround()) return true;
  if (SendsPieces()) return pieces_.TakesNext(sensor, newer);
  // The middleware would keep the newest for who comes, and send them all at once over a radio.
  if (options_.pieces && ends_.depth.matched_readers() + ends_.thermal.matched_readers() == 0) {
    return false;
  }
  MutexLock lock(mutex_);
  return pace_.TakesNext(sensor, clock_.SteadyNow());
}

template <typename Frame>
void DdsPublisher::WaitForRoom(const Writer<Frame>& writer, OutgoingStream* stream,
                               const std::stop_token& stop) {
  MutexLock lock(mutex_);
  bool waited = false;
  // An onlooker that sends no receipts must not stop the scan.
  while (WaitsForGround() && !stream->window().HasRoom() &&
         MayBeAwaited(writer, stream, clock_.SteadyNow())) {
    const SteadyTime now = clock_.SteadyNow();
    if (stop.stop_requested() && !stop_budget_.MayWait(now)) break;
    // Opens the window until the next receipt: a ground that is gone costs its timeout once.
    if (stream->window().GiveUp(now)) {
      ++flow_timeouts_;
      LOG(Publisher, Warning) << "no receipt from the ground, publishing without, timeout_s="
                              << ToSeconds(options_.flow_timeout);
    }
    waited = true;
    changed_.wait_for(lock, kPollInterval);
  }
  if (waited) ++flow_waits_;
}

template <typename Frame>
void DdsPublisher::ForgetWholeFrames(Writer<Frame>* writer, OutgoingStream* stream) {
  if (MutexLock lock(mutex_); !stream->keeps_whole()) return;
  // While some are under way the middleware may have no room for another message.
  if (!writer->WaitForAcknowledgments(Nanoseconds(0))) return;
  const Status forgotten = writer->ForgetPast(options_.edge_id);
  if (forgotten.code() == StatusCode::kUnavailable) return;
  if (!forgotten.ok()) {
    LOG(Publisher, Warning) << "old frames stay for grounds that come: " << forgotten.message();
  }
  MutexLock lock(mutex_);
  stream->OnForgotten();
}

template <typename Frame>
Status DdsPublisher::PublishFrame(const Frame& frame, Writer<Frame>* writer, OutgoingStream* stream,
                                  const std::stop_token& stop) {
  const std::uint64_t number = frame.header.frame_number;
  if (session() != frame.header.session) {
    return FailedPrecondition(
        fmt::format("frame of session {} without BeginSession", frame.header.session));
  }
  if (WaitsForGround()) WaitForRoom(*writer, stream, stop);
  if (stop.stop_requested() && !HasTimeLeft()) {
    MutexLock lock(mutex_);
    stream->OnFailed();
    return NoTimeLeft();
  }
  {
    MutexLock lock(mutex_);
    stream->sent().Note(number, frame.header.capture_time);
  }
  const bool in_pieces = SendsPieces();
  if (in_pieces) ForgetWholeFrames(writer, stream);
  const Status written = in_pieces ? pieces_.Send(frame, PiecePriority::kLive, stop)
                                   : writer->Write(options_.edge_id, frame);
  MutexLock lock(mutex_);
  if (!written.ok()) {
    stream->OnFailed();
    return written;
  }
  stream->OnPublished(number);
  sent_at_ = clock_.SteadyNow();
  if (in_pieces) return OkStatus();
  stream->OnWhole();
  pace_.OnSent(SensorOf(frame), number, sent_at_);
  repairs_.OnSent(frame.image.payload.size(), sent_at_);
  return OkStatus();
}

Status DdsPublisher::Publish(const ExternalOdometrySample& sample, std::stop_token stop) {
  if (stop.stop_requested() && !HasTimeLeft()) return NoTimeLeft();
  return ends_.external_odometry.Write(options_.edge_id, sample);
}

template <typename Frame>
Result<bool> DdsPublisher::BackfillFrame(const Frame& frame, int tries,
                                         Writer<Backfilled<Frame>>* writer, OutgoingStream* stream,
                                         const std::stop_token& stop) {
  {
    MutexLock lock(mutex_);
    if (session_ != frame.header.session) {
      return Err(FailedPrecondition(
          fmt::format("frame of session {}, which has not begun", frame.header.session)));
    }
    stream->sent().NoteAgain(frame.header.frame_number);
  }
  Status written = SendsPieces() && tries < kTriesInPieces
                       ? pieces_.Send(frame, PiecePriority::kBackfill, stop)
                       : writer->Write(options_.edge_id, Backfilled<Frame>{frame});
  if (!written.ok()) return Err(std::move(written));
  MutexLock lock(mutex_);
  sent_at_ = clock_.SteadyNow();
  return stream->OnBackfilled(frame.header.frame_number);
}

Status DdsPublisher::Publish(EdgeStatus status) {
  {
    MutexLock lock(mutex_);
    if (session_) status.session = *session_;
    depth_.FillIn(&status.depth);
    thermal_.FillIn(&status.thermal);
    status.clock_echo = clock_echo_;
    status.served_ground = grounds_.served();
  }
  status.publish_policy = WaitsForGround() ? PublishPolicy::kLossless : PublishPolicy::kLive;
  if (status.clock_echo) status.clock_echo->sent = clock_.Now();
  return ends_.status.Write(options_.edge_id, status);
}

bool DdsPublisher::IsHandled() const {
  MutexLock lock(mutex_);
  const std::optional<Receipt> receipt = receipt_.Get();
  if (depth_.counts().published + thermal_.counts().published == 0) return true;
  // Of pieces that got lost nothing is known, but that they do not come any more.
  if (SendsPieces() && receipt_at_ && *receipt_at_ >= sent_at_ + kPiecesUnderWay) return true;
  return receipt && receipt->session == session_ &&
         receipt->depth.handled >= depth_.counts().next_frame_number &&
         receipt->thermal.handled >= thermal_.counts().next_frame_number;
}

bool DdsPublisher::Drain(Nanoseconds timeout) {
  const SteadyTime deadline = clock_.SteadyNow() + timeout;
  const auto left = [&] {
    return std::max(Nanoseconds(0), Nanoseconds(deadline - clock_.SteadyNow()));
  };
  TakeReceipts();  // While it is known when they came.
  // Acknowledged means delivered to the ground's reader, which may still refuse or drop it.
  if (!ends_.depth.WaitForAcknowledgments(left())) return false;
  if (!ends_.thermal.WaitForAcknowledgments(left())) return false;
  if (!ends_.status.WaitForAcknowledgments(left())) return false;
  // Only the ground's receipts say that it has used or counted everything.
  for (TakeReceipts(); !IsHandled(); TakeReceipts()) {
    if (HasNobodyToWaitFor()) return true;
    if (left() == Nanoseconds(0)) return false;
    MutexLock lock(mutex_);
    changed_.wait_for(lock, std::min(kPollInterval, left()));
  }
  return true;
}

PublisherStats DdsPublisher::stats() const {
  MutexLock lock(mutex_);
  const SteadyTime now = clock_.SteadyNow();
  return {
      .depth = depth_.counts(),
      .thermal = thermal_.counts(),
      .flow_waits = flow_waits_,
      .flow_timeouts = flow_timeouts_,
      .refused = refusals_.total(),
      .ground_present = grounds_.is_present(),
      .receipt_age = receipt_at_ ? std::optional<Nanoseconds>(now - *receipt_at_) : std::nullopt,
      .takes_backfill = grounds_.HasFollower([this](PeerHandle peer) {
        return ends_.backfill_depth.Reaches(peer) && ends_.backfill_thermal.Reaches(peer);
      }),
      .leaves_frames =
          !WaitsForGround() && (SendsPieces() ? pieces_.leaves_frames() : pace_.leaves_frames()),
      .ground_problem = grounds_.Problem(now)};
}

Result<std::unique_ptr<Publisher>> Publisher::Create(const Participant& participant,
                                                     const Clock& clock,
                                                     const PublisherOptions& options) {
  if (const Status valid = Validate(options); !valid.ok()) return Err(valid);
  auto publisher = std::make_unique<DdsPublisher>(clock, options);
  if (const Status opened = publisher->Open(participant); !opened.ok()) return Err(opened);
  return publisher;
}

}  // namespace isotherm
