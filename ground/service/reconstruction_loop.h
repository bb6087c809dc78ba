#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <stop_token>

#include "common/time/clock.h"
#include "ground/options/ground_options.pb.h"
#include "ground/service/live_scan.h"
#include "ground/service/recording_queue.h"
#include "ground/service/result_writer.h"
#include "ground/service/scan_board.h"
#include "ground/service/scan_rebuild.h"
#include "ground/service/session_item.h"
#include "ground/subscriber/subscriber.h"

namespace isotherm {

/// Holds those that a reconstruction gives something to.
struct ReconstructionSinks {
  Subscriber& subscriber;     ///< Feedback, to the rig.
  RecordingQueue& recording;  ///< Feedback, to the disk.
  ResultWriter& results;      ///< Scans that have ended.
  ScanBoard& board;
  ThreadProgress& progress;
  ThreadProgress& reading;         ///< The same while the thread reads from the disk.
  ConsoleFeed* console = nullptr;  ///< Shows the scan, if there is a console.
};

/// Reconstructs one session after the other, hands ended ones over to have their results written,
/// and sends feedback. Thread-bound to the reconstruction thread.
class ReconstructionLoop {
 public:
  ReconstructionLoop(const GroundOptions& options, const Clock& clock,
                     const ReconstructionSinks& sinks)
      : clock_(clock),
        options_(options),
        subscriber_(sinks.subscriber),
        recording_(sinks.recording),
        results_(sinks.results),
        board_(sinks.board),
        progress_(sinks.progress),
        reading_(sinks.reading),
        console_(sinks.console) {}

  /// Until stop is requested; frames that wait then are counted and left out.
  void Run(SessionQueue& queue, const std::stop_token& stop);
  /// The last failure. Not while it runs.
  const Status& status() const { return status_; }

 private:
  void Handle(const SessionStart& start);
  void Handle(const RigDescription& rig);
  void Handle(const SessionCounters& counters);
  void Handle(const ExternalOdometrySample& sample);
  void Handle(const ReceivedDepth& frame);
  void Handle(const ReceivedThermal& frame);
  void Handle(const Feedback& /*feedback*/) {}  // Comes from here.
  void Handle(const SessionClock& clock);
  void Handle(const SessionMark& /*mark*/) {}  // For the recording.
  /// Begins with what an earlier process has recorded of this scan, if it has.
  void BeginRebuild();
  /// Goes on with it.
  void StepRebuild();
  /// Returns the next item; while there is none, does what is left for the rebuild, then for the
  /// console.
  std::optional<SessionItem> Next(SessionQueue& queue, const std::stop_token& stop);
  template <typename Frame>
  void HandleFrame(const Frame& frame);
  void SendFeedback(const Feedback& feedback);
  /// Tells how much of the disk the results will need.
  void EstimateResults();
  void End();

  const Clock& clock_;
  const GroundOptions& options_;
  Subscriber& subscriber_;
  RecordingQueue& recording_;
  ResultWriter& results_;
  ScanBoard& board_;
  ThreadProgress& progress_;
  ThreadProgress& reading_;
  ConsoleFeed* const console_;
  std::stop_token stop_;
  bool started_ = false;  ///< A session runs; without a scan if none could be begun.
  SessionStart start_;    ///< How the session that runs began.
  std::unique_ptr<LiveScan> scan_;
  std::optional<ScanRebuild> rebuild_;  ///< Nothing once all is in scan_.
  int items_since_step_ = 0;            ///< Handled since the rebuild has gone on.
  std::uint64_t unprocessed_ = 0;       ///< Frames of this session.
  std::uint64_t result_bytes_ = 0;
  std::uint64_t ended_result_bytes_ = 0;  ///< Results of scans that are still being written.
  Status status_;
};

}  // namespace isotherm
