#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <stop_token>
#include <utility>

#include "common/time/clock.h"
#include "common/time/line_limiter.h"
#include "common/time/thread_progress.h"
#include "ground/options/ground_options.pb.h"
#include "ground/service/recording_queue.h"
#include "ground/service/scan_folders.h"
#include "ground/service/session_item.h"

namespace isotherm {

struct ScanBoard;

/// Where a distributor sends items, and what it reports to.
struct DistributorSinks {
  SessionQueue& reconstruction;
  RecordingQueue& recording;
  ScanBoard& board;
  ThreadProgress& progress;
};

/// Turns what the subscriber delivers into items for both consumers. Frames that arrive before
/// their session's calibration are kept until it is there. It waits for the reconstruction, whose
/// work cannot be left out uncounted, but for the disk only for a bounded time: frames that find no
/// room there are left out of the recording, counted. Thread-bound to the receive thread.
class Distributor {
 public:
  Distributor(const GroundOptions& options, bool single_scan, const Clock& clock,
              const DistributorSinks& sinks)
      : options_(options),
        single_scan_(single_scan),
        folders_(options, single_scan),
        clock_(clock),
        reconstruction_(sinks.reconstruction),
        recording_(sinks.recording),
        board_(sinks.board),
        progress_(sinks.progress) {}

  /// Nothing is waited for any more when `stop` is requested.
  void SetStop(std::stop_token stop) { stop_ = std::move(stop); }

  /// Begins a session, or takes what is new of its cameras.
  void OnRig(const RigDescription& rig);
  /// Takes a frame or an odometry pose.
  void OnItem(SessionItem item);
  void OnClock(const SessionClock& clock);
  /// For the recording.
  void OnMark(const SessionMark& mark);
  /// Takes a frame that came too late for the reconstruction: it is only recorded.
  void OnLate(const SessionItem& item) { Record(item); }
  void OnSessionEnd(const SessionCounters& counters);

 private:
  void OnRigAnew(const RigDescription& rig);
  /// To both consumers.
  void Send(SessionItem item);
  /// A beginning or an end: to both, whatever waits there.
  void SendMark(const SessionItem& mark);
  void Reconstruct(SessionItem item);
  void Record(const SessionItem& item);
  /// Records a frame, or counts it as left out if there is no room for it.
  template <typename Frame>
  void RecordFrame(Frame frame, Sensor sensor);
  void LogRecording(bool taken);

  const GroundOptions& options_;
  const bool single_scan_;
  ScanFolders folders_;
  const Clock& clock_;
  SessionQueue& reconstruction_;
  RecordingQueue& recording_;
  ScanBoard& board_;
  ThreadProgress& progress_;
  std::stop_token stop_;
  std::optional<std::uint64_t> session_;
  SessionStart start_;  ///< How the session that runs began.
  bool over_ = false;   ///< The single scan has ended.
  bool recording_behind_ = false;
  std::deque<SessionItem> early_;
  LineLimiter early_limiter_;
};

}  // namespace isotherm
