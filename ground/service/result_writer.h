#pragma once

#include <condition_variable>
#include <functional>
#include <memory>
#include <optional>
#include <stop_token>

#include "common/base/mutex.h"
#include "common/time/clock.h"
#include "common/time/thread_progress.h"
#include "ground/json/json.h"
#include "ground/options/ground_options.pb.h"
#include "ground/service/live_scan.h"
#include "ground/service/scan_board.h"
#include "ground/service/session_item.h"
#include "ground/subscriber/session_counters.h"

namespace isotherm {

/// A scan whose last frame was processed.
struct EndedScan {
  SessionStart start;
  std::unique_ptr<LiveScan> scan;  ///< nullptr if it was recorded only.
  std::uint64_t unprocessed = 0;   ///< Frames that were left in the queue at the stop.
};

/// Writes the results of one scan after the other, so that the next scan can be received and
/// reconstructed meanwhile. At most one more waits: there are never more than three models in
/// memory. If the disk is stuck, the results of one more are lost, and nobody waits for long: the
/// recording has its frames. Enqueue() is for the reconstruction thread; the rest is bound to the
/// thread of results.
class ResultWriter {
 public:
  /// Returns what is known of a session's frames by now.
  using CountersSource = std::function<SessionCounters(std::uint64_t session)>;
  /// These are called after each scan, whatever became of its results.
  struct Handlers {
    /// Gets the scan once the results of the live model are there.
    std::function<void(std::unique_ptr<LiveScan>)> written;
    std::function<void()> completed;  ///< Nothing more is done for the scan. May be empty.
  };
  ResultWriter(const GroundOptions& options, const Clock& clock, CountersSource counters,
               ScanBoard& board, ThreadProgress& progress, Handlers handlers)
      : options_(options),
        clock_(clock),
        counters_(std::move(counters)),
        board_(board),
        progress_(progress),
        handlers_(std::move(handlers)) {}

  /// Takes a scan, or gives its results up, counted and logged, if there is no room for it. With a
  /// live rig, which does not wait for us, it decides at once; with a replay after kReplayPatience.
  /// After a stop it waits until there is room: nothing is received meanwhile.
  void Enqueue(EndedScan ended, const std::stop_token& stop);
  /// Writes until stop is requested and no scan waits.
  void Run(const std::stop_token& stop);
  /// The last failure. Not while it runs.
  const Status& status() const { return status_.ok() ? given_up_ : status_; }

 private:
  /// An edge that waits for the ground can wait for the results of the scan before; a live one
  /// sends frames meanwhile, so that it is not waited for at all.
  static constexpr Nanoseconds kReplayPatience = std::chrono::seconds(10);

  /// False if there is still no room after `patience`.
  bool WaitForRoom(MutexLock& lock, Nanoseconds patience, const std::stop_token& stop)
      REQUIRES(mutex_);
  void GiveUp(const EndedScan& ended);
  std::optional<EndedScan> Take(const std::stop_token& stop);
  /// Processes a scan's last frames, checks its delay and writes its results.
  /// Returns its statistics; null if there are no results.
  Json FinishScan(EndedScan& ended, const std::stop_token& stop);
  /// Brings in what came too late for the model, and gives up when another scan waits.
  void Complete(const SessionStart& start, const Json& stats, const std::stop_token& stop);
  /// Writes into the scan's folder or, if that fails, into another. Returns the summary.
  Result<std::string> WriteWithFallback(LiveScan& scan, const CalibrationCheckReport& calibration,
                                        const Json& stats, const std::filesystem::path& folder);

  const GroundOptions& options_;
  const Clock& clock_;
  const CountersSource counters_;
  ScanBoard& board_;
  ThreadProgress& progress_;
  const Handlers handlers_;
  Mutex mutex_;
  std::condition_variable_any changed_;
  std::optional<EndedScan> waiting_ GUARDED_BY(mutex_);
  Status status_;
  Status given_up_;  ///< The reconstruction thread's; the result thread never reads it.
};

}  // namespace isotherm
