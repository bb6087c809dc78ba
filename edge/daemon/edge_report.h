#pragma once

#include <limits>
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

/// Holds what the operator's line is made of.
struct EdgeSituation {
  EdgeStatus status;
  SensorCounters depth;
  SensorCounters thermal;
  bool ground_present = false;
  std::string ground_problem{};              ///< Says why it is not well; empty: it is.
  std::optional<Feedback> feedback;          ///< The newest.
  std::optional<Nanoseconds> feedback_age;   ///< nullopt: not known.
  std::optional<Nanoseconds> receipt_age{};  ///< Since it was heard last; nullopt: not yet.
  std::vector<std::string> problems{};       ///< Each says in a few words why this is not well.
  /// Until the recording ends for lack of space; NaN = not known.
  double disk_left_s = std::numeric_limits<double>::quiet_NaN();
};

/// One line for the operator's journal: what the ground says, or what is wrong with it, then rates,
/// drops, NUC, clock and disk.
std::string StatusLine(const EdgeSituation& situation);

/// The same for a terminal that may be narrow (FitLine), the most important first: what the ground
/// advises, what is wrong, frames dropped, then why it advises that and the rest.
std::vector<std::string> StatusParts(const EdgeSituation& situation);

/// Returns what became of every frame, and how soon the ground answered, printed at exit.
/// `recording`: whether there was one.
std::string Summary(const FrameCounters& counters, bool recording,
                    const std::optional<Receipt>& receipt, const FeedbackLatency& feedback);

}  // namespace isotherm
