#include "ground/subscriber/dds_subscriber.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <variant>

#include "common/base/host_name.h"
#include "common/base/log.h"
#include "common/base/pause.h"

namespace isotherm {
namespace {

using namespace std::chrono_literals;

/// Frames that are taken of one stream before the other has its turn.
constexpr int kFramesPerRound = 8;
constexpr int kBackfillPerRound = 2;
constexpr int kPiecesPerRound = 256;   ///< Some frames.
constexpr int kMessagesPerRound = 64;  ///< More is somebody sending without end.
/// These are more frames than a reader keeps: somebody sends without end.
constexpr int kMaxTurnsBehindFrames = 32;
/// A fast sender must not wait for the next interval.
constexpr int kFramesPerReceipt = 8;
/// At the beginning of a session the rig is told of each frame: from that it learns how much the
/// link carries. Some seconds of both cameras.
constexpr std::uint64_t kFirstFrames = 200;
/// The rig learns this often how many pieces arrive.
constexpr Nanoseconds kPieceReportInterval = 50ms;
/// Presence is looked at this often.
constexpr Nanoseconds kIdleInterval = 100ms;

/// Once it has arrived, a backfilled frame is a frame like any other, only late.
template <typename Message>
Message ContentOf(Received<Message>&& received) {
  return std::move(received.message);
}
template <typename Frame>
Frame ContentOf(Received<Backfilled<Frame>>&& received) {
  return std::move(received.message.frame);
}

}  // namespace

DdsSubscriber::DdsSubscriber(const Clock& clock, const SubscriberOptions& options,
                             SubscriberHandlers handlers)
    : clock_(clock),
      options_(options),
      handlers_(std::move(handlers)),
      own_hello_{
          .role = Role::kGround, .software_version = options.software_version, .host = HostName()},
      followed_(options.edge_id),
      depth_("depth", options.reorder_window, &refusals_.depth, handlers_.depth,
             handlers_.late_depth),
      thermal_("thermal", options.reorder_window, &refusals_.thermal, handlers_.thermal,
               handlers_.late_thermal),
      gate_(
          [this](RigSample&& sample) {
            std::visit([&](auto& message) { OnAdmitted(std::move(message), sample.arrival); },
                       sample.content);
          },
          [this](const RigSample& sample, RefusalCause cause) { refusals_.Add(sample, cause); }),
      sessions_(options.end_grace),
      clock_comparison_(static_cast<std::uint64_t>(ToNanoseconds(clock.Now()))),
      clock_watch_(options.max_clock_offset),
      // Not from 1, so that the result for an earlier run of this ground is not taken for ours.
      next_command_(static_cast<std::uint64_t>(ToNanoseconds(clock.Now()))) {}

void DdsSubscriber::Run(std::stop_token stop) {
  const std::stop_callback wake(stop, [this] {
    if (const auto ends = joined_ends()) ends->wait_set.Wake();
  });
  while (!stop.stop_requested()) {
    if (!FollowNetwork()) {
      Pause(stop, kIdleInterval);
    } else {
      ends_->wait_set.Wait(TimeToNextDuty(clock_.SteadyNow()));
      while (TakeRound() && !stop.stop_requested()) Housekeep();
    }
    Housekeep();
  }
  if (ends_) TakeRound();
  depth_.DeliverAll();
  thermal_.DeliverAll();
  Housekeep();
  SendReceipt(clock_.SteadyNow());
}

bool DdsSubscriber::FollowNetwork() {
  std::shared_ptr<GroundEndpoints> joined = joined_ends();
  if (joined != ends_) {
    // It asks the readers that go.
    peers_ = {};
    ends_ = std::move(joined);
  }
  return ends_ != nullptr;
}

bool DdsSubscriber::TakeRound() {
  const int taken = TakeDescriptions() + TakeMessages();
  const int depth_taken = TakeSamples(&ends_->depth, kFramesPerRound);
  const int thermal_taken = TakeSamples(&ends_->thermal, kFramesPerRound);
  const int pieces_taken = TakePieces();
  // A few at a time: what is live comes first.
  const int backfill_taken = TakeSamples(&ends_->backfill_depth, kBackfillPerRound) +
                             TakeSamples(&ends_->backfill_thermal, kBackfillPerRound);
  // A description may end a session, whose last frames were sent before it on other topics: those
  // have arrived by now, and are taken first.
  const bool frames_are_left = std::max(depth_taken, thermal_taken) == kFramesPerRound ||
                               pieces_taken == kPiecesPerRound ||
                               backfill_taken >= kBackfillPerRound;
  if (!descriptions_.empty() &&
      (!frames_are_left || ++turns_behind_frames_ == kMaxTurnsBehindFrames)) {
    AdmitDescriptions();
  }
  return taken + depth_taken + thermal_taken + pieces_taken + backfill_taken > 0;
}

int DdsSubscriber::TakeDescriptions() {
  if (!descriptions_.empty()) return 0;
  return ends_->rig.Take(
      [this](Received<RigDescription>&& received) {
        if (!IsFollowed(received.edge_id)) return;
        descriptions_.push_back(
            {peers_.Identify(ends_->rig, received.writer),
             {.content = std::move(received.message), .arrival = clock_.Now()}});
      },
      kMessagesPerRound);
}

void DdsSubscriber::AdmitDescriptions() {
  turns_behind_frames_ = 0;
  for (auto& [peer, description] : std::exchange(descriptions_, {})) {
    // It waited behind frames, and with a session that ended meanwhile the rig's place is free.
    if (gate_.owner() != 0 && peer != gate_.owner() && !peers_.IsPresent(peer)) {
      refusals_.Add(description, RefusalCause::kOtherWriter);
    } else {
      gate_.Add(peer, std::move(description), clock_.SteadyNow());
    }
  }
}

int DdsSubscriber::TakeMessages() {
  const int taken = ends_->peers.Take([this](Received<Hello>&& peer) { OnPeer(peer); });
  return taken + TakeSamples(&ends_->external_odometry, kMessagesPerRound) +
         TakeSamples(&ends_->status, kMessagesPerRound) +
         TakeSamples(&ends_->results, kMessagesPerRound);
}

template <typename Message>
int DdsSubscriber::TakeSamples(Reader<Message>* reader, int max_samples) {
  return reader->Take(
      [this, reader](Received<Message>&& received) {
        if (!IsFollowed(received.edge_id)) return;
        const PeerHandle peer = peers_.Identify(*reader, received.writer);
        // Comes back in OnAdmitted, now or later, if it is the rig's.
        gate_.Add(peer, {.content = ContentOf(std::move(received)), .arrival = clock_.Now()},
                  clock_.SteadyNow());
      },
      max_samples);
}

int DdsSubscriber::TakePieces() {
  return ends_->pieces.Take(
      [this](Received<FramePiece>&& received) {
        if (!IsFollowed(received.edge_id)) return;
        const PeerHandle peer = peers_.Identify(ends_->pieces, received.writer);
        const SteadyTime now = clock_.SteadyNow();
        auto frame = pieces_.Add(peer, gate_.owner(), std::move(received.message), now);
        if (!frame) return;
        gate_.Add(peer, {.content = std::move(*frame), .arrival = clock_.Now()}, now);
      },
      kPiecesPerRound);
}

void DdsSubscriber::ReportPieces(SteadyTime now) {
  piece_report_due_ = now + kPieceReportInterval;
  const std::optional<PieceReport> report = pieces_.TakeReport(gate_.owner());
  // What is not reported is reported with the next.
  if (report) static_cast<void>(ends_->piece_report.Write(followed_.edge_id(), *report));
}

void DdsSubscriber::OnAdmitted(const RigDescription& rig, CaptureTime /*arrival*/) {
  // What still waits for its turn belongs to the session before.
  if (std::exchange(described_session_, rig.session) != rig.session) {
    depth_.DeliverAll();
    thermal_.DeliverAll();
  }
  depth_.SetReplay(rig.waits_for_ground);
  thermal_.SetReplay(rig.waits_for_ground);
  if (handlers_.rig) handlers_.rig(rig);
}

void DdsSubscriber::OnAdmitted(const ExternalOdometrySample& sample, CaptureTime /*arrival*/) {
  if (handlers_.external_odometry) handlers_.external_odometry(sample);
}

void DdsSubscriber::OnAdmitted(const CommandResult& result, CaptureTime /*arrival*/) {
  if (handlers_.command_result) handlers_.command_result(result);
}

void DdsSubscriber::OnAdmitted(const EdgeStatus& status, CaptureTime /*arrival*/) {
  const ClockReading now = ReadClocks(clock_);
  if (status.clock_echo) clock_comparison_.Add(*status.clock_echo, now.steady);
  echo_.OnStatus(gate_.owner(), status, now.steady);
  served_.OnStatus(status, ends_->self, now.steady);
  clock_watch_.Update(status, clock_comparison_.Offset(now), ReadKernelClock(), now.steady);
  const std::vector<ScanMark> marks = sessions_.OnStatus(status, now.steady);
  sessions_.SetClock(clock_watch_.clock());
  if (handlers_.status) handlers_.status(status);
  if (handlers_.clock) handlers_.clock(clock_watch_.clock());
  if (!handlers_.mark) return;
  for (const ScanMark& mark : marks) handlers_.mark({status.session, mark});
}

template <typename ReceivedFrame>
void DdsSubscriber::OnFrame(typename StreamReceiver<ReceivedFrame>::Encoded&& frame,
                            StreamReceiver<ReceivedFrame>* receiver, CaptureTime arrival) {
  const SteadyTime now = clock_.SteadyNow();
  const std::uint64_t session = frame.header.session;
  if (!receiver->Add(std::move(frame), arrival, now)) return;
  sessions_.OnFrame(session, now);
  ++frames_since_receipt_;
  receiver->DeliverDue(now);
}

bool DdsSubscriber::IsFollowed(const std::string& edge_id) {
  if (followed_.See(edge_id)) return true;
  MutexLock lock(mutex_);
  ++stats_.other_edge;
  return false;
}

void DdsSubscriber::OnPeer(const Received<Hello>& peer) {
  if (peer.message.role != Role::kEdge) return;
  const Status compatible = CheckCompatible(own_hello_, peer.message);
  const PeerHandle process = peers_.Identify(ends_->peers, peer.writer);
  if (!compatible.ok()) {
    watch_.AddStranger(process);
    return refusals_.all.Add(RefusalCause::kOtherVersion, compatible.message());
  }
  watch_.Add(process, peer.edge_id, peer.message.host);
  // An edge that waits for a ground has sent nothing else.
  followed_.See(peer.edge_id);
}

void DdsSubscriber::EnterRecorded() {
  const SteadyTime now = clock_.SteadyNow();
  for (const auto& [session, sensor, frames] : TakeRecorded()) {
    if (sensor == Sensor::kDepth) depth_.AddRecorded(session, frames, now);
    if (sensor == Sensor::kThermal) thermal_.AddRecorded(session, frames, now);
  }
}

void DdsSubscriber::Housekeep() {
  if (handlers_.turn) handlers_.turn();
  EnterRecorded();
  const SteadyTime now = clock_.SteadyNow();
  depth_.DeliverDue(now);
  thermal_.DeliverDue(now);
  if (now >= receipt_due_ || frames_since_receipt_ >= frames_per_receipt_) SendReceipt(now);
  if (ends_ && now >= piece_report_due_) ReportPieces(now);
  CloseSessions(now);
  if (ends_ && now >= look_due_) LookAround(now);
  KeepCounters();
  MutexLock lock(mutex_);
  stats_.counters = history_.Newest();
  stats_.refusals = refusals_.all.counts();
  stats_.refused = refusals_.all.total();
}

void DdsSubscriber::LookAround(SteadyTime now) {
  look_due_ = now + kIdleInterval;
  const auto is_present = [this](PeerHandle peer) { return peers_.IsPresent(peer); };
  gate_.Update(now, is_present);
  const std::string edge_id = followed_.edge_id();
  const RigSighting sighting =
      watch_.Look(now, edge_id, ends_->status.matched_writers() > 0, is_present);
  std::string problem =
      watch_.LookAtWays(now, edge_id, ends_->announced.Of(Role::kEdge), echo_.deaf_rig());
  if (problem.empty()) problem = SecondGroundText();
  if (!sighting.problem.empty()) problem = sighting.problem;
  for (const std::uint64_t session : sighting.sessions_to_refuse) {
    Receipt refusal;
    refusal.session = session;
    refusal.verdict = SessionVerdict::kOtherRig;
    static_cast<void>(ends_->receipt.Write(edge_id, refusal));  // Repeated every second.
  }
  MutexLock lock(mutex_);
  stats_.rig_problem = std::move(problem);
  if (sighting.present == stats_.edge_present) return;
  stats_.edge_present = sighting.present;
  stats_.edge_lost = sighting.present ? std::nullopt : std::optional(now);
  LOG(Subscriber, Info) << (sighting.present ? "rig found" : "rig lost");
}

std::string DdsSubscriber::SecondGroundText() const {
  if (served_.other() == 0) return {};
  const std::map<PeerHandle, Announcement> grounds = ends_->announced.Of(Role::kGround);
  const auto other = grounds.find(served_.other());
  if (other == grounds.end()) return {};  // It has left, and the rig does not know it yet.
  return fmt::format(
      "THE RIG SERVES ANOTHER GROUND STATION, on \"{}\": nothing is sent again for this one, and "
      "advice is the other's",
      other->second.host);
}

void DdsSubscriber::KeepCounters() {
  const std::vector<std::uint64_t> sessions = sessions_.sessions();
  // The streams know no more than two; the counters of older ones are as they were.
  const std::size_t first = sessions.size() - std::min<std::size_t>(sessions.size(), 2);
  MutexLock lock(mutex_);
  for (std::size_t i = first; i < sessions.size(); ++i) {
    const std::uint64_t session = sessions[i];
    history_.Keep(sessions_.Counters(depth_.tally(session), thermal_.tally(session)),
                  i + 1 == sessions.size(), refusals_.all.total());
  }
}

void DdsSubscriber::CloseSessions(SteadyTime now) {
  while (const auto session = sessions_.oldest_open()) {
    auto counters = sessions_.TryClose(depth_.tally(*session), thermal_.tally(*session), now);
    if (!counters) return;
    counters->refused_samples = refusals_.all.total();
    gate_.OnClosed(*session);
    // Complete, but perhaps waiting for numbers that were never published.
    depth_.DeliverAll();
    thermal_.DeliverAll();
    SendReceipt(now);
    KeepCounters();
    if (handlers_.session_end) handlers_.session_end(*counters);
  }
}

void DdsSubscriber::SendReceipt(SteadyTime now) {
  frames_since_receipt_ = 0;
  // From the deadline before, so that the rate does not drift; from now after a pause, and after
  // receipts that were sent sooner because many frames came.
  receipt_due_ =
      std::clamp(receipt_due_ + options_.receipt_interval, now, now + options_.receipt_interval);
  const std::string edge_id = followed_.edge_id();
  if (edge_id.empty() || !ends_) return;
  Receipt receipt;  // Without a session it says only which rig this ground follows.
  if (const auto session = sessions_.newest()) {
    receipt.session = *session;
    receipt.depth = depth_.receipt(*session);
    receipt.thermal = thermal_.receipt(*session);
  }
  const bool is_new = receipt.depth.received + receipt.thermal.received < kFirstFrames;
  frames_per_receipt_ = is_new ? 1 : kFramesPerReceipt;
  receipt.clock_ping = clock_comparison_.Ping(clock_.SteadyNow());
  const Status sent = ends_->receipt.Write(edge_id, receipt);
  if (!sent.ok()) {
    LOG(Subscriber, Debug) << "receipt not sent: " << sent.message();
  }
}

Nanoseconds DdsSubscriber::TimeToNextDuty(SteadyTime now) const {
  SteadyTime next = now + kIdleInterval;
  next = std::min(next, receipt_due_);
  for (const auto& deadline : {depth_.deadline(), thermal_.deadline(), sessions_.deadline()}) {
    if (deadline) next = std::min(next, *deadline);
  }
  return std::max(Nanoseconds(0), Nanoseconds(next - now));
}

}  // namespace isotherm
