#include "edge/daemon/edge_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string_view>
#include <utility>

#include "common/messages/backlog.h"
#include "common/messages/feedback_text.h"
#include "common/recording/clock_record.h"
#include "common/recording/disk_time.h"

namespace isotherm {
namespace {

/// "idle", "desired (held for 20 s: ...)", "error, STORM: 9/min, 41 % closed".
std::string NucText(const NucReport& nuc) {
  std::string text(ToString(nuc.state));
  if (!nuc.reason.empty()) text += fmt::format(" ({})", nuc.reason);
  if (nuc.storm) {
    text += fmt::format(", STORM: {}/min, {:.0f} % closed", nuc.closings_per_minute,
                        100.0 * nuc.closed_fraction);
  }
  if (nuc.warming_up) text += ", warming up";
  return text;
}

// By default the ground raises an alarm at this difference, too (live.expert.max_clock_offset_s).
constexpr double kDoubtfulClock_s = 0.05;

std::uint64_t Dropped(const SensorCounters& counters) {
  return counters.rejected + counters.left_out + counters.record_queue_full +
         counters.record_failed + counters.publish_queue_full + counters.left_for_later +
         counters.publish_failed;
}

/// At the end of a scan, when no frame may be on its way any more:
/// "captured 900 = recorded 890 + rejected 0 + queue full 10 + failed 0".
std::string Equation(std::string_view done, const SensorCounters& counters, std::uint64_t succeeded,
                     std::uint64_t queue_full, std::uint64_t failed, std::int64_t unaccounted) {
  std::string text =
      fmt::format("captured {} = {} {} + rejected {} + queue full {} + failed {}",
                  counters.captured, done, succeeded, counters.rejected, queue_full, failed);
  if (counters.left_out != 0) {
    text += fmt::format(" + no free slot in the camera's process {}", counters.left_out);
  }
  // Never seen if the counters are right: said rather than hidden.
  if (unaccounted != 0) text += fmt::format(" + unaccounted {}", unaccounted);
  return text;
}

/// " (camera lost)" or " (camera blind)", behind a rate; nothing for a camera that works.
std::string StateText(const CameraReport& camera) {
  if (camera.state == CameraState::kLost) return " (camera lost)";
  return camera.state == CameraState::kBlind ? " (camera blind)" : "";
}

/// Says what the recording has of what the ground lacks.
std::string RecordedText(const EdgeStatus& status) {
  if (!std::isfinite(status.spool_fill_ratio)) return "and there is no recording";
  if (std::isnan(status.spool_keeps_s)) return "the newest of it is kept";
  if (status.spool_keeps_s <= 0.0) return "what it lacks is recorded";
  return fmt::format("the newest {:.0f} s are kept", status.spool_keeps_s);
}

/// "LOST for 12 s, what it lacks is recorded"; "absent" before it was there, and when it may leave.
std::string AbsentText(const EdgeSituation& situation) {
  if (!situation.receipt_age || situation.status.scan_state != ScanState::kScanning)
    return "absent";
  return fmt::format("LOST for {:.0f} s, {}", ToSeconds(*situation.receipt_age),
                     RecordedText(situation.status));
}

std::string GroundText(const EdgeSituation& situation) {
  if (!situation.ground_problem.empty()) return situation.ground_problem;
  if (!situation.ground_present) return AbsentText(situation);
  return situation.feedback ? FeedbackText(*situation.feedback) : "no feedback yet";
}

/// Returns how old the advice is, if a hand that follows it has moved on; otherwise nothing.
std::string OldText(const EdgeSituation& situation) {
  constexpr Nanoseconds kOld = std::chrono::seconds(1);
  const bool is_old = situation.ground_present && situation.feedback_age &&
                      *situation.feedback_age > kOld &&
                      situation.status.scan_state == ScanState::kScanning;
  return is_old ? fmt::format("advice {:.1f} s OLD", ToSeconds(*situation.feedback_age)) : "";
}

/// "ground lacks 640 frames of 9 s", which the recording has, and how many it has no more; nothing
/// while no more than usual are on their way.
std::string LackingText(const EdgeStatus& status) {
  std::string text = HasBacklog(status) ? "ground lacks " + BacklogText(status) : "";
  if (status.frames_gone > 0) {
    text += fmt::format("{}{} frames DELETED that it does not have", text.empty() ? "" : ", ",
                        status.frames_gone);
  }
  return text;
}

/// Says how many arrived of those that left the rig; the line above has the others. The ground's
/// summary calls the difference missing.
std::string ReceiptText(const StreamReceipt& receipt, std::uint64_t published) {
  // Of a scan that was interrupted it may have frames that nobody has recorded.
  return fmt::format("ground received {} of {} published", receipt.received,
                     std::max(published, receipt.received));
}

}  // namespace

double RateMeter::Update(std::uint64_t count, SteadyTime now) {
  double rate = 0.0;
  if (last_time_ && now > *last_time_) {
    rate = static_cast<double>(count - last_count_) / ToSeconds(now - *last_time_);
  }
  last_time_ = now;
  last_count_ = count;
  return rate;
}

StreamStatus ToStreamStatus(const SensorCounters& counters, double rate_hz) {
  StreamStatus status;
  // Captured is what was published and what was dropped: numbers that a restart has left out, too.
  status.captured = counters.captured + counters.lost_by_restart;
  status.published = counters.published;
  status.rate_hz = rate_hz;
  status.queue_frames = static_cast<std::uint32_t>(counters.OnTheWayToGround());
  status.dropped = {{"rejected", counters.rejected},
                    {"no free slot in the camera's process", counters.left_out},
                    {"lost by a restart", counters.lost_by_restart},
                    {"queue full", counters.publish_queue_full},
                    {kLeftForLater, counters.left_for_later},
                    {"publish failed", counters.publish_failed}};
  return status;
}

std::uint64_t ToReport(std::optional<std::uint64_t> disk_free_bytes) {
  // On the wire 0 stands for "not known", so that a full disk is one byte.
  return disk_free_bytes ? std::max<std::uint64_t>(*disk_free_bytes, 1) : 0;
}

void AddHostStatus(const HostStatus& host, EdgeStatus& status) {
  status.disk_free_bytes = ToReport(host.disk_free_bytes);
  status.cpu_temperature_celsius = host.cpu_temperature_celsius;
  status.clock = ToReport(host.clock);
}

std::string_view CameraText(CameraState state) {
  switch (state) {
    case CameraState::kNone:
      return "none";
    case CameraState::kWorking:
      return "working";
    case CameraState::kLost:
      return "lost, the scan goes on without it";
    case CameraState::kBlind:
      return "blind: covered, too close or too far";
  }
  return "?";
}

std::string CameraSummary(const CameraReport& depth, const CameraReport& thermal) {
  std::string text;
  const auto add = [&text](std::string_view name, const CameraReport& camera) {
    if (camera.state == CameraState::kNone || std::isnan(camera.stamping_p99_s)) return;
    text += fmt::format(
        "{}  camera failed {} times, stamped {:.2f} ms after arrival (p99 {:.2f} ms)\n", name,
        camera.failures, camera.stamping_p50_s * 1e3, camera.stamping_p99_s * 1e3);
  };
  add("depth  ", depth);
  add("thermal", thermal);
  return text;
}

std::optional<std::string> ClockProblem(const KernelClock& clock) {
  if (!clock.synchronised) {
    return "the wall clock is not synchronised: capture times are right among themselves, but not "
           "as UTC, and the recording says so. Install chrony with a server that the rig reaches "
           "(deploy/chrony, docs/timing.md); chronyc tracking says how it is doing";
  }
  // The kernel's offset is what is still being slewed away; its error is what the time service
  // estimates.
  const double off_s = std::max(std::abs(clock.offset_s), clock.estimated_error_s);
  if (!(off_s > kDoubtfulClock_s)) return std::nullopt;
  return fmt::format(
      "the wall clock is off by about {:.0f} ms by its own estimate: wait until chrony has "
      "corrected it (chronyc waitsync), or see chronyc sources for a better server",
      1e3 * off_s);
}

std::map<std::string, std::string> ClockMetadata(const KernelClock& clock, TimeBase time_base) {
  if (time_base != TimeBase::kWallClock) return {{"time_base", "that of the replayed recording"}};
  std::map<std::string, std::string> metadata = ToMetadata(ToReport(clock));
  metadata["time_base"] = "wall clock at the start, carried on by the monotonic clock";
  return metadata;
}

std::string StatusLine(const EdgeSituation& situation) {
  const EdgeStatus& status = situation.status;
  std::string line = "ground: " + GroundText(situation);
  if (const std::string old = OldText(situation); !old.empty()) line += ", " + old;
  line += fmt::format(
      " | depth {:.1f}/s{}  thermal {:.1f}/s{}  NUC {}  recorded {}  published {}  dropped {}  "
      "clock {}",
      status.depth.rate_hz, StateText(status.depth_camera), status.thermal.rate_hz,
      StateText(status.thermal_camera), NucText(status.nuc),
      situation.depth.recorded + situation.thermal.recorded,
      situation.depth.published + situation.thermal.published,
      Dropped(situation.depth) + Dropped(situation.thermal), ToText(status.clock));
  if (const std::string lacking = LackingText(status); !lacking.empty()) line += "  " + lacking;
  const std::string stamps = StampText(status.depth_camera, status.thermal_camera);
  if (!stamps.empty()) line += "  stamps " + stamps;
  if (const std::string disk = DiskTimeText(situation.disk_left_s); !disk.empty())
    line += "  " + disk;
  return line;
}

std::vector<std::string> StatusParts(const EdgeSituation& situation) {
  const EdgeStatus& status = situation.status;
  // The terminal shows as many parts as fit: first what needs the operator, last what is only nice
  // to know.
  std::vector<std::string> urgent = situation.problems;
  for (const auto& [name, camera] :
       {std::pair("depth", status.depth_camera), std::pair("thermal", status.thermal_camera)}) {
    if (const std::string state = StateText(camera); !state.empty()) urgent.push_back(name + state);
  }
  const std::uint64_t dropped = Dropped(situation.depth) + Dropped(situation.thermal);
  if (dropped > 0) urgent.push_back(fmt::format("dropped {}", dropped));
  if (std::string lacking = LackingText(status); !lacking.empty())
    urgent.push_back(std::move(lacking));
  if (std::string old = OldText(situation); !old.empty()) urgent.push_back(std::move(old));
  std::vector<std::string> parts;
  if (situation.ground_present && situation.feedback) {
    parts = FeedbackParts(*situation.feedback, std::move(urgent));
  } else {
    parts = {"ground: " + (situation.ground_present ? "no feedback yet" : AbsentText(situation))};
    parts.insert(parts.end(), urgent.begin(), urgent.end());
  }
  parts.push_back(fmt::format("{:.0f}+{:.0f}/s", status.depth.rate_hz, status.thermal.rate_hz));
  if (std::string disk = DiskTimeText(situation.disk_left_s); !disk.empty())
    parts.push_back(std::move(disk));
  parts.push_back("NUC " + NucText(status.nuc));
  parts.push_back(
      fmt::format("recorded {}", situation.depth.recorded + situation.thermal.recorded));
  parts.push_back(
      fmt::format("published {}", situation.depth.published + situation.thermal.published));
  parts.push_back("clock " + ToText(status.clock));
  return parts;
}

std::string Summary(const FrameCounters& counters, bool recording,
                    const std::optional<Receipt>& receipt, const FeedbackLatency& feedback) {
  std::string text;
  for (const Sensor sensor : {Sensor::kDepth, Sensor::kThermal}) {
    const bool is_depth = sensor == Sensor::kDepth;
    const SensorCounters counts = counters.Get(sensor);
    const std::string_view name = is_depth ? "depth  " : "thermal";
    if (recording) {
      text += fmt::format("{}  {}\n", name,
                          Equation("recorded", counts, counts.recorded, counts.record_queue_full,
                                   counts.record_failed, counts.OnTheWayToDisk()));
    }
    const std::string left = counts.left_for_later > 0
                                 ? fmt::format(" + {} {}", kLeftForLater, counts.left_for_later)
                                 : "";
    text += fmt::format("{}  {}{}\n", name,
                        Equation("published", counts, counts.published, counts.publish_queue_full,
                                 counts.publish_failed, counts.OnTheWayToGround()),
                        left);
    if (counts.lost_in_camera > 0) {
      text +=
          fmt::format("{}  lost in the camera or its library {}\n", name, counts.lost_in_camera);
    }
    if (counts.lost_by_restart > 0) {
      text += fmt::format(
          "{}  numbers left out while the edge was started again {}: not captured, or not recorded "
          "just before\n",
          name, counts.lost_by_restart);
    }
    if (receipt) {
      text +=
          fmt::format("{}  {}\n", name,
                      ReceiptText(is_depth ? receipt->depth : receipt->thermal, counts.published));
    }
  }
  text += fmt::format("feedback {} messages, depth capture to arrival {}\n", feedback.count,
                      LatencyText(feedback));
  return text;
}

}  // namespace isotherm
