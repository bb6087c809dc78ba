#include "ground/service/status_reporter.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "common/base/log.h"
#include "common/base/service.h"
#include "common/messages/backlog.h"
#include "common/messages/feedback_text.h"
#include "ground/subscriber/clock_watch.h"

namespace isotherm {
namespace {

constexpr const char* kSeparator = " | ";

/// "300 of 301 depth".
std::string ArrivedText(const char* name, const StreamCounters& counters) {
  return fmt::format("{} of {} {}", counters.received, counters.published, name);
}

void LogCamera(const char* name, const StreamMode& camera) {
  if (camera.model.empty()) return;
  LOG(Ground, Info) << name << " camera: " << camera.model << ", serial=" << camera.serial
                    << " mode=" << ModeText(camera);
}

std::uint64_t Dropped(const StreamStatus& stream) {
  std::uint64_t sum = 0;
  for (const DropCount& drop : stream.dropped) sum += drop.frames;
  return sum;
}

constexpr double kBytesPerGb = 1e9;
/// A hand that follows advice of so long ago has moved on. Not tuned.
constexpr double kOldFeedback_s = 1.0;
/// The rig keeps this in reserve at most: there its recording ends (spool.expert.reserve_mb).
constexpr double kRigDiskEnds_gb = 1.0;
/// A recording of ten minutes and the reserve take this much.
constexpr double kRigDiskLow_gb = 4.0;

/// Returns what is free on the rig's disk; nullopt if the rig does not say.
std::optional<double> RigDisk_gb(const GroundSituation& situation) {
  if (!situation.edge || situation.edge->disk_free_bytes == 0) return std::nullopt;
  return static_cast<double>(situation.edge->disk_free_bytes) / kBytesPerGb;
}

/// Returns what the operator should do something about.
std::vector<std::string> TroublesOf(const GroundSituation& situation) {
  constexpr Nanoseconds kSlow = std::chrono::seconds(2);
  std::vector<std::string> parts;
  if (situation.behind.thermal_frames > 0)
    parts.push_back(fmt::format("BEHIND {}", situation.behind.thermal_frames));
  if (situation.recording_at_it > kSlow) {
    parts.push_back(fmt::format("DISK STUCK for {:.0f} s", ToSeconds(situation.recording_at_it)));
  }
  if (const auto gb = RigDisk_gb(situation); gb && *gb < kRigDiskEnds_gb)
    parts.push_back(fmt::format("RIG'S DISK FULL, {:.1f} GB", *gb));
  if (situation.scans_given_up > 0)
    parts.push_back(fmt::format("RESULTS OF {} SCANS LOST", situation.scans_given_up));
  if (situation.link.counters.clock && situation.link.counters.clock->alarm)
    parts.emplace_back("CLOCK ALARM");
  if (situation.folder_problem) parts.push_back("NO OUTPUT FOLDER: " + *situation.folder_problem);
  if (!situation.moved_calibration.empty())
    parts.push_back("CALIBRATION: " + situation.moved_calibration);
  if (situation.recording.paused) parts.emplace_back("NOT RECORDING");
  if (situation.recording.left_out() > 0) {
    parts.push_back(fmt::format("RECORDING LACKS {} frames", situation.recording.left_out()));
  }
  return parts;
}

/// "RIG LOST for 12 s, it records: nothing is lost".
std::string LostText(const GroundSituation& situation) {
  std::string recorded = "and it does not record";
  if (situation.edge && std::isfinite(situation.edge->spool_fill_ratio)) {
    const double keeps_s = situation.edge->spool_keeps_s;
    recorded = "it records: nothing is lost";
    if (keeps_s > 0.0) recorded = fmt::format("it keeps the newest {:.0f} s", keeps_s);
    if (std::isnan(keeps_s)) recorded = "it keeps the newest only";
  }
  return fmt::format("RIG LOST for {:.0f} s, {}", ToSeconds(situation.rig_lost_for), recorded);
}

/// Adds what has arrived of the scan, and where it stays.
void AddScan(const GroundSituation& situation, std::vector<std::string>& parts) {
  const SessionCounters& counters = situation.link.counters;
  if (situation.link.edge_present && !counters.closed && situation.edge)
    parts.push_back(LinkText(*situation.edge));
  parts.push_back(fmt::format("received {}, {}", ArrivedText("depth", counters.depth),
                              ArrivedText("thermal", counters.thermal)));
  if (situation.edge) {
    const std::uint64_t dropped = Dropped(situation.edge->depth) + Dropped(situation.edge->thermal);
    if (dropped > 0) parts.push_back(fmt::format("dropped by the rig {}", dropped));
    if (const double age_s = situation.edge->feedback.p50_s; age_s > kOldFeedback_s)
      parts.push_back(fmt::format("advice is {:.1f} s old when it reaches the rig", age_s));
  }
  if (std::string disk = DiskText(situation.recording); !disk.empty())
    parts.push_back(std::move(disk));
  if (const auto gb = RigDisk_gb(situation); gb && *gb >= kRigDiskEnds_gb && *gb < kRigDiskLow_gb)
    parts.push_back(fmt::format("rig's disk low, {:.1f} GB left", *gb));
  if (situation.behind.thermal_frames > 0) {
    parts.push_back(fmt::format("reconstruct scan.mcap again: {} thermal frames were left out",
                                situation.behind.thermal_frames));
  }
  parts.push_back("rig's clock: " + (counters.clock ? ClockText(*counters.clock) : "unknown"));
}

}  // namespace

std::string RebuildText(double fraction) {
  return fmt::format("making the model anew of its recording, {:.0f} %", 100.0 * fraction);
}

void LogCameras(const RigDescription& rig) {
  LogCamera("depth", rig.depth);
  LogCamera("thermal", rig.thermal);
}

std::vector<std::string> StatusParts(const GroundSituation& situation) {
  const SubscriberStats& link = situation.link;
  std::vector<std::string> parts;
  if (situation.problem) parts.push_back("STUCK: " + *situation.problem);
  if (!link.rig_problem.empty()) parts.push_back(link.rig_problem);
  const bool has_scan = link.counters.session != 0 && !link.counters.closed;
  if (!link.edge_present && has_scan) parts.push_back(LostText(situation));
  std::vector<std::string> said = TroublesOf(situation);
  if (situation.rebuilt_fraction) {
    parts.push_back(RebuildText(*situation.rebuilt_fraction));
  } else if (situation.feedback) {
    said = FeedbackParts(*situation.feedback, std::move(said));
  } else if (has_scan) {
    parts.emplace_back("scanning");
  } else {
    parts.emplace_back(link.edge_present ? "rig found, no scan yet" : "waiting for a rig");
  }
  parts.insert(parts.end(), said.begin(), said.end());
  if (situation.scans_being_written > 0) parts.emplace_back("writing results");
  if (link.counters.session == 0) return parts;
  AddScan(situation, parts);
  return parts;
}

std::string StatusText(const GroundSituation& situation) {
  return FitLine(StatusParts(situation), kSeparator, std::numeric_limits<std::size_t>::max());
}

void StatusReporter::Report(const GroundSituation& situation) {
  line_.Show(StatusParts(situation), kSeparator);
  const SteadyTime now = clock_.SteadyNow();
  if (now >= next_status_) {
    next_status_ = now + kStatusInterval;
    NotifyStatus(StatusText(situation));
  }
  if (now < next_log_) return;
  next_log_ = now + kLogInterval;
  const SessionCounters& counters = situation.link.counters;
  if (line_.is_terminal() || counters.session == 0 || counters.closed) return;
  LOG(Ground, Info) << StatusText(situation);
}

}  // namespace isotherm
