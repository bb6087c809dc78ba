#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <stop_token>
#include <string>
#include <utility>
#include <vector>

#include "common/base/mutex.h"
#include "common/base/status.h"
#include "common/time/clock.h"
#include "common/transport/endpoints.h"
#include "ground/subscriber/clock_comparison.h"
#include "ground/subscriber/clock_watch.h"
#include "ground/subscriber/echo_watch.h"
#include "ground/subscriber/followed_rig.h"
#include "ground/subscriber/ground_endpoints.h"
#include "ground/subscriber/peer_table.h"
#include "ground/subscriber/piece_collector.h"
#include "ground/subscriber/rig_gate.h"
#include "ground/subscriber/rig_watch.h"
#include "ground/subscriber/served_watch.h"
#include "ground/subscriber/session_history.h"
#include "ground/subscriber/session_tracker.h"
#include "ground/subscriber/stream_receiver.h"
#include "ground/subscriber/stream_refusals.h"
#include "ground/subscriber/subscriber.h"

namespace isotherm {

/// The subscriber over DDS; what its methods promise is said there.
class DdsSubscriber final : public Subscriber {
 public:
  DdsSubscriber(const Clock& clock, const SubscriberOptions& options, SubscriberHandlers handlers);

  void Run(std::stop_token stop) override;
  bool Leave(const std::function<bool()>& go_on) override;
  Status Join(const Participant& participant) override;
  Status Publish(const Feedback& feedback) override;
  Result<std::uint64_t> Send(Command command) override;
  void AddRecorded(RecordedNumbers recorded) override;
  SubscriberStats stats() const override;
  SessionCounters counters(std::uint64_t session) const override;
  const RefusalCounter& refusals() const override { return refusals_.all; }

 private:
  /// Takes over what others have left or joined. Returns whether there is a network.
  bool FollowNetwork();
  std::shared_ptr<GroundEndpoints> joined_ends() const {
    MutexLock lock(mutex_);
    return joined_ends_;
  }
  /// Takes some of what has arrived; false if there was nothing.
  bool TakeRound();
  int TakeMessages();
  /// Keeps the descriptions of the rig that have arrived, until the frames before them were taken.
  int TakeDescriptions();
  void AdmitDescriptions();
  /// Hands what has arrived at `reader` to the gate; samples of other rigs are only counted.
  template <typename Message>
  int TakeSamples(Reader<Message>* reader, int max_samples);
  int TakePieces();
  /// Does what is due: deliveries, receipts, closed sessions, statistics.
  void Housekeep();
  std::vector<RecordedNumbers> TakeRecorded() {
    MutexLock lock(mutex_);
    return std::exchange(recorded_, {});
  }
  /// Tells both streams what an earlier process has recorded of them.
  void EnterRecorded();
  void CloseSessions(SteadyTime now);
  /// Keeps the counters of the newest session and of the one before, as they are now.
  void KeepCounters();
  void SendReceipt(SteadyTime now);
  void ReportPieces(SteadyTime now);
  Nanoseconds TimeToNextDuty(SteadyTime now) const;
  void OnPeer(const Received<Hello>& peer);
  // What the gate lets through: the lambda that the constructor gives it calls one of these.
  void OnAdmitted(const RigDescription& rig, CaptureTime arrival);
  void OnAdmitted(const EdgeStatus& status, CaptureTime arrival);
  void OnAdmitted(const ExternalOdometrySample& sample, CaptureTime arrival);
  void OnAdmitted(const CommandResult& result, CaptureTime arrival);
  void OnAdmitted(EncodedDepthFrame&& frame, CaptureTime arrival) {
    OnFrame(std::move(frame), &depth_, arrival);
  }
  void OnAdmitted(EncodedThermalFrame&& frame, CaptureTime arrival) {
    OnFrame(std::move(frame), &thermal_, arrival);
  }
  template <typename ReceivedFrame>
  void OnFrame(typename StreamReceiver<ReceivedFrame>::Encoded&& frame,
               StreamReceiver<ReceivedFrame>* receiver, CaptureTime arrival);
  /// Finds out who is there, who is the rig, and who only says so.
  void LookAround(SteadyTime now);
  std::string SecondGroundText() const;
  /// True for samples of the rig that is followed; counts those of others.
  bool IsFollowed(const std::string& edge_id);

  const Clock& clock_;
  const SubscriberOptions options_;
  const SubscriberHandlers handlers_;
  const Hello own_hello_;
  FollowedRig followed_;
  StreamRefusals refusals_;

  // Of the thread in Run().
  std::shared_ptr<GroundEndpoints> ends_;  ///< Null between Leave() and Join().
  StreamReceiver<ReceivedDepth> depth_;
  StreamReceiver<ReceivedThermal> thermal_;
  PeerTable peers_;
  PieceCollector pieces_{&refusals_};
  SteadyTime piece_report_due_{};
  RigGate gate_;
  std::vector<std::pair<PeerHandle, RigSample>> descriptions_;  ///< Not yet at the gate.
  int turns_behind_frames_ = 0;  ///< For so many turns they have waited.
  RigWatch watch_{gate_};
  SteadyTime look_due_{};
  SessionTracker sessions_;
  std::uint64_t described_session_ = 0;  ///< Session of the newest description of the rig.
  ClockComparison clock_comparison_;
  ClockWatch clock_watch_;
  ServedWatch served_;
  EchoWatch echo_;
  SteadyTime receipt_due_{};
  int frames_since_receipt_ = 0;
  int frames_per_receipt_ = 1;

  mutable Mutex mutex_;
  std::shared_ptr<GroundEndpoints> joined_ends_ GUARDED_BY(mutex_);
  std::uint64_t next_command_ GUARDED_BY(mutex_);
  SubscriberStats stats_ GUARDED_BY(mutex_);
  SessionHistory history_ GUARDED_BY(mutex_);
  std::vector<RecordedNumbers> recorded_ GUARDED_BY(mutex_);  ///< Not yet with the streams.
};

}  // namespace isotherm
