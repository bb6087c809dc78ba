#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <stop_token>

#include "common/base/service.h"
#include "common/time/clock.h"
#include "ground/ground_options.pb.h"
#include "ground/ground_service.h"
#include "ground/live_scan.h"
#include "ground/session_item.h"
#include "ground/subscriber/subscriber.h"

namespace isotherm {

/// Reconstructs one session after the other, writes its results and sends feedback. Thread-bound to
/// the reconstruction thread, but for `processed`.
class ReconstructionLoop {
 public:
  /// `recording` gets the feedback.
  ReconstructionLoop(const GroundOptions& options, const ServiceMode& mode, const Clock& clock,
                     Subscriber& subscriber, ItemQueue& recording, StopSignal& signal)
      : clock_(clock),
        options_(options),
        mode_(mode),
        subscriber_(subscriber),
        recording_(recording),
        signal_(signal) {}

  /// Until stop is requested; frames that wait then are counted and left out.
  void Run(ItemQueue& queue, const std::stop_token& stop);
  /// The last failure.
  const Status& status() const { return status_; }
  /// Frames so far.
  std::uint64_t processed() const { return processed_; }

 private:
  void Handle(const SessionStart& start);
  void Handle(const SessionAccount& account);
  void Handle(const OutsidePoseSample& sample);
  void Handle(const ReceivedDepth& frame);
  void Handle(const ReceivedThermal& frame);
  void Handle(const Feedback& /*feedback*/) {}   // Comes from here.
  void Handle(const ClockAccount& /*clock*/) {}  // For the recording.
  template <typename Frame>
  void HandleFrame(const Frame& frame);
  void End(const SessionAccount& account);
  Json DescribeEnd(const SessionAccount& account, const RecordingOutcome& recording) const;

  const Clock& clock_;
  const GroundOptions& options_;
  const ServiceMode mode_;
  Subscriber& subscriber_;
  ItemQueue& recording_;
  StopSignal& signal_;
  std::stop_token stop_;
  SessionStart start_;
  std::unique_ptr<LiveScan> scan_;
  SessionAccount last_account_;
  std::uint64_t unprocessed_ = 0;
  std::atomic<std::uint64_t> processed_{0};
  Status status_;
};

}  // namespace isotherm
