#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "common/messages/messages.h"
#include "edge/daemon/host_status.h"
#include "edge/frame_counters/frame_counters.h"
#include "edge/timestamper/time_base.h"

namespace isotherm {

/// Turns counts into frames per second. Thread-compatible.
class RateMeter {
 public:
  /// Frames per second since the last call; 0 at the first.
  double Update(std::uint64_t count, SteadyTime now);

 private:
  std::optional<SteadyTime> last_time_;
  std::uint64_t last_count_ = 0;
};

/// The part of the status message that the counters know: frames and drops by reason on the way to
/// the ground.
StreamStatus ToStreamStatus(const SensorCounters& counters, double rate_hz);

/// Free space as EdgeStatus has it.
std::uint64_t ToReport(std::optional<std::uint64_t> disk_free_bytes);

/// The host's part.
void AddHostStatus(const HostStatus& host, EdgeStatus& status);

/// "working", "lost, the scan goes on without it", ...
std::string_view CameraText(CameraState state);

/// Says how often the cameras failed and how soon their frames were stamped, to be printed at exit;
/// empty if there are none.
std::string CameraSummary(const CameraReport& depth, const CameraReport& thermal);

/// Returns what is wrong with the wall clock and what to do about it; nullopt if nothing is.
std::optional<std::string> ClockProblem(const KernelClock& clock);

/// Returns what the recording says of the clock that stamps its frames, at the start of a scan.
std::map<std::string, std::string> ClockMetadata(const KernelClock& clock, TimeBase time_base);

/// One line for the operator's journal: what the ground says, or what is wrong with it, then rates,
/// drops, NUC and clock.
std::string StatusLine(const EdgeStatus& status, const FrameCounters& counters, bool ground_present,
                       const std::optional<Feedback>& feedback,
                       const std::string& ground_problem = {});

/// The same for a terminal that may be narrow (FitLine), the most important first: what the ground
/// advises, what is wrong (`problems`, each in a few words), frames dropped, then the rest.
std::vector<std::string> StatusParts(const EdgeStatus& status, const FrameCounters& counters,
                                     bool ground_present, const std::optional<Feedback>& feedback,
                                     const std::vector<std::string>& problems);

/// Returns what became of every frame, and how soon the ground answered, printed at exit.
/// `recording`: whether there was one.
std::string Summary(const FrameCounters& counters, bool recording,
                    const std::optional<Receipt>& receipt, const FeedbackLatency& feedback);

}  // namespace isotherm
