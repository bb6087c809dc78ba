#pragma once

#include <optional>
#include <string>
#include <vector>

#include "common/base/terminal_line.h"
#include "common/time/clock.h"
#include "ground/service/health.h"
#include "ground/service/scan_board.h"
#include "ground/subscriber/subscriber.h"

namespace isotherm {

/// Holds what the operator's line is made of.
struct GroundSituation {
  SubscriberStats link;
  Nanoseconds rig_lost_for{0};       ///< If it is not there.
  std::optional<Feedback> feedback;  ///< The newest of this scan.
  std::optional<EdgeStatus> edge;
  BehindCounts behind;
  RecordingProgress recording;
  std::optional<double> rebuilt_fraction;  ///< The part of the recording in the model.
  Nanoseconds recording_at_it{0};          ///< How long the disk has been at one piece of work.
  int scans_being_written = 0;
  int scans_given_up = 0;                       ///< Their results are lost.
  std::optional<std::string> problem;           ///< The part that is stuck.
  std::string moved_calibration;                ///< By the last scan; empty = nothing.
  std::optional<std::string> folder_problem{};  ///< The reason for which nothing can be written.
};

/// "making the model anew of its recording, 40 %".
std::string RebuildText(double fraction);

/// A part per fact, the most important first: what to do, what is wrong, how the scan is, what has
/// arrived, how long the disk lasts, how the rig's clock is.
std::vector<std::string> StatusParts(const GroundSituation& situation);
/// The same in one line.
std::string StatusText(const GroundSituation& situation);

/// Writes what the rig's cameras are into the log; a replay or a simulation has none.
void LogCameras(const RigDescription& rig);

/// Shows the line on a terminal, in place; tells the service manager, and elsewhere the journal
/// every ten seconds while a scan runs. Thread-compatible.
class StatusReporter {
 public:
  /// `clock` must outlive it.
  explicit StatusReporter(const Clock& clock)
      : clock_(clock),
        next_status_(clock.SteadyNow() + kStatusInterval),
        next_log_(clock.SteadyNow() + kLogInterval) {}

  /// To be called more often than the intervals.
  void Report(const GroundSituation& situation);

 private:
  /// The line is for people who watch, the log for those who look later: an hour of log is 360
  /// lines.
  static constexpr Nanoseconds kStatusInterval = std::chrono::seconds(1);
  static constexpr Nanoseconds kLogInterval = std::chrono::seconds(10);

  const Clock& clock_;
  SteadyTime next_status_;
  SteadyTime next_log_;
  TerminalLine line_;
};

}  // namespace isotherm
