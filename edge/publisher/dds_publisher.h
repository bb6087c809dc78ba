#pragma once

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <memory>
#include <optional>
#include <stop_token>
#include <string>
#include <string_view>

#include "common/base/host_name.h"
#include "common/base/mutex.h"
#include "common/base/status.h"
#include "common/concurrency/latest_value.h"
#include "common/time/clock.h"
#include "edge/publisher/arrival_watch.h"
#include "edge/publisher/edge_endpoints.h"
#include "edge/publisher/ground_watch.h"
#include "edge/publisher/live_pace.h"
#include "edge/publisher/outgoing_stream.h"
#include "edge/publisher/piece_sender.h"
#include "edge/publisher/publisher.h"
#include "edge/publisher/repair_watch.h"
#include "edge/publisher/stop_budget.h"

namespace isotherm {

/// The publisher over DDS; what its methods promise is said there.
class DdsPublisher final : public Publisher {
 public:
  DdsPublisher(const Clock& clock, const PublisherOptions& options)
      : clock_(clock),
        options_(options),
        own_hello_{
            .role = Role::kEdge, .software_version = options.software_version, .host = HostName()},
        policy_(options.policy),
        depth_(MakeStream(options)),
        thermal_(MakeStream(options)),
        grounds_(options.edge_id) {}

  Status Open(const Participant& participant);

  void Run(std::stop_token stop, const PublisherHandlers& handlers) override;
  bool WaitForGround(Nanoseconds timeout, std::stop_token stop) override;
  Status BeginSession(const RigDescription& rig, const SessionBefore& before) override;
  Status Announce(const RigDescription& rig) override;
  bool TakesNext(Sensor sensor, std::size_t newer) override;
  Status Publish(const EncodedDepthFrame& frame, std::stop_token stop) override {
    return PublishFrame(frame, &ends_.depth, &depth_, stop);
  }
  Status Publish(const EncodedThermalFrame& frame, std::stop_token stop) override {
    return PublishFrame(frame, &ends_.thermal, &thermal_, stop);
  }
  Result<bool> Backfill(const EncodedDepthFrame& frame, int tries,
                        const std::stop_token& stop) override {
    return BackfillFrame(frame, tries, &ends_.backfill_depth, &depth_, stop);
  }
  Result<bool> Backfill(const EncodedThermalFrame& frame, int tries,
                        const std::stop_token& stop) override {
    return BackfillFrame(frame, tries, &ends_.backfill_thermal, &thermal_, stop);
  }
  Status Publish(const ExternalOdometrySample& sample, std::stop_token stop) override;
  Status Publish(EdgeStatus status) override;
  Status Answer(const CommandResult& result) override {
    return ends_.result.Write(options_.edge_id, result);
  }
  bool Drain(Nanoseconds timeout) override;
  void SetPolicy(PublishPolicy policy) override {
    MutexLock lock(mutex_);
    policy_ = policy;
    is_link_poor_ = false;
  }
  PublisherStats stats() const override;
  std::optional<Receipt> receipt() const override { return receipt_.Get(); }
  SessionBefore so_far() const override {
    MutexLock lock(mutex_);
    return {.depth = depth_.so_far(), .thermal = thermal_.so_far()};
  }

 private:
  static OutgoingStream MakeStream(const PublisherOptions& options) {
    return {static_cast<std::size_t>(options.flow_window_frames), options.flow_timeout};
  }

  template <typename Frame>
  Status PublishFrame(const Frame& frame, Writer<Frame>* writer, OutgoingStream* stream,
                      const std::stop_token& stop);
  /// Returns whether each frame waits for room in the flow window, as with kLossless over a link
  /// that carries whole frames.
  bool WaitsForGround() const { return policy_ == PublishPolicy::kLossless && !is_link_poor_; }
  /// Returns whether frames go in pieces: nothing of these is sent again, and a ground is there
  /// that reads them.
  bool SendsPieces() const { return !WaitsForGround() && options_.pieces && reads_pieces_; }
  /// Makes the middleware forget what went whole, once it has arrived: a ground that comes later is
  /// not to begin with it, old as it is.
  template <typename Frame>
  void ForgetWholeFrames(Writer<Frame>* writer, OutgoingStream* stream);
  template <typename Frame>
  Result<bool> BackfillFrame(const Frame& frame, int tries, Writer<Backfilled<Frame>>* writer,
                             OutgoingStream* stream, const std::stop_token& stop);
  template <typename Frame>
  void WaitForRoom(const Writer<Frame>& writer, OutgoingStream* stream,
                   const std::stop_token& stop);
  /// After stop was requested.
  bool HasTimeLeft() {
    MutexLock lock(mutex_);
    return stop_budget_.MayWrite(clock_.SteadyNow());
  }
  /// Messages for other rigs share the topics.
  bool IsOurs(std::string_view edge_id) const { return edge_id == options_.edge_id; }
  void TakeReceipts();
  void OnReceipt(const Received<Receipt>& received) REQUIRES(receipts_mutex_);
  void OnPieceReport(const Received<PieceReport>& received);
  void OnFeedback(const Received<Feedback>& received, const PublisherHandlers& handlers);
  void OnPeer(const Received<Hello>& peer);
  void LookForGround();
  void LookAtWays(SteadyTime now);
  /// Goes over to pieces, for this session, if the lossless policy finds that it must.
  void LookAtRepairs(SteadyTime now) REQUIRES(mutex_);
  /// Says why the ground's word about this session cannot be true.
  std::optional<RefusalCause> RefusalOf(const Receipt& receipt) const REQUIRES(mutex_) {
    if (const auto cause = depth_.sent().Check(receipt.depth)) return cause;
    return thermal_.sent().Check(receipt.thermal);
  }
  std::optional<RefusalCause> RefusalOf(const Feedback& feedback, PeerHandle sender) const
      REQUIRES(mutex_) {
    if (!grounds_.Knows(sender)) return RefusalCause::kNotTheGround;
    if (feedback.session != session_) return RefusalCause::kOtherSession;
    return depth_.sent().Check(feedback);
  }
  std::optional<std::uint64_t> session() const {
    MutexLock lock(mutex_);
    return session_;
  }
  bool IsGroundReady() const;
  /// Returns whether the ground that follows this rig, or may, reads what `writer` writes: an
  /// onlooker is not waited for.
  template <typename Frame>
  bool IsAwaited(const Writer<Frame>& writer) const REQUIRES(mutex_) {
    return grounds_.IsAwaited([&](PeerHandle peer) { return writer.Reaches(peer); },
                              clock_.SteadyNow());
  }
  /// Returns whether IsAwaited, or whether a reader has just come that may be the ground's.
  template <typename Frame>
  bool MayBeAwaited(const Writer<Frame>& writer, OutgoingStream* stream, SteadyTime now) const
      REQUIRES(mutex_) {
    if (grounds_.IsRefused(now)) return false;
    return stream->HasNewReader(writer.matched_readers(), now) || IsAwaited(writer);
  }
  bool HasNobodyToWaitFor() const {
    MutexLock lock(mutex_);
    return !IsAwaited(ends_.depth) && !IsAwaited(ends_.thermal);
  }
  bool IsHandled() const;

  const Clock& clock_;
  const PublisherOptions options_;
  const Hello own_hello_;
  RefusalCounter refusals_;
  EdgeEndpoints ends_;
  PieceSender pieces_{clock_, options_.edge_id, ends_.pieces};
  // Run() takes receipts, and so does Drain(), before or after Run().
  Mutex receipts_mutex_;
  LatestValue<Receipt> receipt_;
  std::atomic<PublishPolicy> policy_;
  std::atomic<bool> reads_pieces_{false};  // The ground that follows this rig.
  std::atomic<bool> is_link_poor_{false};  // Whole frames do not get along, in this session.
  SteadyTime ways_due_{};                  // Of the thread in Run().

  mutable Mutex mutex_;
  std::condition_variable_any changed_;
  std::optional<std::uint64_t> session_ GUARDED_BY(mutex_);
  LivePace pace_ GUARDED_BY(mutex_);
  RepairWatch repairs_ GUARDED_BY(mutex_);
  ArrivalWatch arrival_ GUARDED_BY(mutex_);
  OutgoingStream depth_ GUARDED_BY(mutex_);
  OutgoingStream thermal_ GUARDED_BY(mutex_);
  std::uint64_t flow_waits_ GUARDED_BY(mutex_) = 0;
  std::uint64_t flow_timeouts_ GUARDED_BY(mutex_) = 0;
  std::optional<SteadyTime> receipt_at_ GUARDED_BY(mutex_);  // The newest of the session.
  SteadyTime sent_at_ GUARDED_BY(mutex_){};                  // The newest frame.
  std::optional<ClockEcho> clock_echo_ GUARDED_BY(mutex_);   // Of the newest receipt.
  GroundWatch grounds_ GUARDED_BY(mutex_);
  StopBudget stop_budget_ GUARDED_BY(mutex_);
};

}  // namespace isotherm
