#pragma once

#include <optional>

#include "edge/daemon/session_start.h"
#include "edge/frame_counters/frame_counters.h"
#include "edge/publisher/publisher.h"
#include "edge/spool/interrupted_scan.h"

namespace isotherm {

/// Returns the scan that a process before was interrupted in and that `session` can go on with: the
/// cameras that are there and the calibration are the same, and not more than spool.resume_s have
/// passed. Logs why a scan that is recent enough is not gone on with.
std::optional<InterruptedScan> FindScanToResume(const EdgeOptions& options,
                                                const EdgeSession& session);

/// Has `session` go on with `before`.
void Resume(const InterruptedScan& before, EdgeSession& session);

/// Returns what the process before has published. All that it had recorded counts: what never left
/// is sent from the recording.
SessionBefore PublishedBy(const InterruptedScan& before, const EdgeSession& session);

/// Counts the frames that the process before had recorded as captured and published, and the
/// numbers that are left out.
void CountBefore(const InterruptedScan& before, const EdgeSession& session,
                 FrameCounters& counters);

}  // namespace isotherm
