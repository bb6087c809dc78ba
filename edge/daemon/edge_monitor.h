#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "common/base/terminal_line.h"
#include "common/messages/feedback_text.h"
#include "common/time/clock.h"
#include "edge/daemon/edge_report.h"
#include "edge/daemon/host_status.h"
#include "edge/frame_counters/frame_counters.h"
#include "edge/pipeline/camera_health.h"
#include "edge/pipeline/edge_pipeline.h"
#include "edge/publisher/publisher.h"

namespace isotherm {

/// EdgeMonitor asks this of the computer, and tells this to the service manager. Functions, so
/// that tests play both.
struct MonitorHost {
  std::function<HostStatus()> read;
  std::function<bool(std::string_view)> notify_status;
  std::function<void()> notify_alive;
  std::optional<Nanoseconds> watchdog_interval;  ///< Nullopt: nobody watches.
};

/// The computer that this program runs on.
MonitorHost ThisComputer();

/// Holds what the monitor looks at and speaks for.
struct EdgeMonitorParts {
  const Clock& clock;
  EdgePipeline& pipeline;
  Publisher& publisher;
  const FrameCounters& counters;
  const CameraHealth& health;
};

/// Does what is left to the daemon's main thread beside the line: answers commands, publishes the
/// status once a second, tells the operator and the service manager. Thread-bound.
class EdgeMonitor {
 public:
  /// `parts` must outlive it. `image_file`: where the confidence image goes (empty: nowhere).
  EdgeMonitor(const EdgeMonitorParts& parts, std::filesystem::path image_file,
              MonitorHost host = ThisComputer());

  /// Does what is due; call it often.
  void Tick();
  /// Publishes the final counts.
  void PublishEnd();

 private:
  EdgeStatus MakeStatus(ScanState scan_state, SteadyTime now);
  /// The newest feedback, if it was not shown yet: image, status line or journal.
  void ShowFeedback();
  EdgeSituation Situation() const;
  void ShowLine();
  /// Returns what is wrong, each in a sentence that says what to do.
  std::vector<std::string> Problems() const;
  /// To the service manager, at once if something became wrong or right.
  void ReportStatus();
  /// Returns whether the program makes progress, with or without cameras.
  bool GetsOn(SteadyTime now);
  /// Logs what became of the cameras since the last status.
  void LogCameras(const EdgeStatus& before) const;
  /// Logs that synchronisation was lost or found; how it is at the start, the start logs.
  void LogClock();
  void Log();
  void FeedWatchdog(SteadyTime now);

  const Clock& clock_;
  EdgePipeline& pipeline_;
  Publisher& publisher_;
  const FrameCounters& counters_;
  const CameraHealth& health_;
  const std::filesystem::path image_file_;
  const MonitorHost host_;
  std::optional<TerminalLine> line_{std::in_place};  ///< Until the end.
  const bool terminal_;
  bool synchronised_;
  SteadyTime next_status_;
  SteadyTime next_log_;
  SteadyTime next_feed_;
  RateMeter depth_rate_;
  RateMeter thermal_rate_;
  /// The newest frames of one camera.
  struct Newest {
    std::uint64_t captured = 0;
    SteadyTime at{};
  };
  Newest newest_depth_, newest_thermal_;
  std::vector<std::string> reported_;  ///< Problems, to the service manager.
  bool is_said_ = true;                ///< They reached it.
  bool stuck_ = false;
  EdgeStatus status_;  ///< The last one published.
  std::uint64_t feedback_shown_ = 0;
  FeedbackReporter reporter_;
  bool image_fails_ = false;
};

}  // namespace isotherm
