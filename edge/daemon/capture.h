#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <stop_token>

#include "common/base/exit_deadline.h"
#include "common/time/clock.h"
#include "edge/daemon/session_start.h"
#include "edge/frame_counters/frame_counters.h"
#include "edge/pipeline/camera_health.h"
#include "edge/publisher/publisher.h"
#include "edge/source/frame_source.h"
#include "edge/spool/spool.h"

namespace isotherm {

/// The exit status (EX_CANTCREAT of sysexits.h) of an edge whose recording could not be created or
/// not be finished.
inline constexpr int kExitRecording = 73;

/// Ends the process in time once it was told to leave, whatever it is at then.
struct Leaving {
  ExitDeadline deadline;
  std::atomic<int> status_if_stuck{0};
};

/// Holds what a scan works with from its beginning to its end.
struct CaptureParts {
  const EdgeOptions& options;
  const EdgeSession& session;
  FrameSource& source;
  FrameCounters& counters;
  CameraHealth& health;
  Publisher& publisher;
  Leaving& leaving;
  /// Kept up to date for those who wait for the end: frames are captured, or on their way to a
  /// ground that takes them.
  std::atomic<bool>& is_scanning;
  std::function<void()> on_idle;  ///< Called when the scan has ended and another is waited for.
  const Clock& clock;
  const std::stop_token& stop;
};

/// Tells how a scan has ended.
struct CaptureEnd {
  int status = 0;             ///< Becomes that of the process, if nothing worse follows.
  bool another_scan = false;  ///< Ordered; otherwise the process is to leave.
};

/// Captures until told to leave, or until the next scan is ordered, then passes on what is under
/// way. A scan that was ordered to stop ends at once, and what follows is waited for.
CaptureEnd Capture(const CaptureParts& parts, std::unique_ptr<Spool> spool);

}  // namespace isotherm
