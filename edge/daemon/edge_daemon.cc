#include "edge/daemon/edge_daemon.h"

#include <fmt/format.h>

#include <atomic>
#include <memory>
#include <optional>
#include <stop_token>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "common/base/host_name.h"
#include "common/base/log.h"
#include "common/base/processor_time.h"
#include "common/doubts/calibration_doubts.h"
#include "common/doubts/doubts.h"
#include "common/options/text_proto.h"
#include "common/recording/recording_parts.h"
#include "common/rig/rig_calibration.h"
#include "common/rig/rig_calibration.pb.h"
#include "common/transport/join_domain.h"
#include "common/transport/network_addresses.h"
#include "edge/daemon/capture.h"
#include "edge/daemon/edge_report.h"
#include "edge/daemon/host_status.h"
#include "edge/daemon/idle_rig.h"
#include "edge/daemon/open_source.h"
#include "edge/daemon/resume_scan.h"
#include "edge/daemon/session_start.h"
#include "edge/daemon/stop_limits.h"
#include "edge/options/edge_options.pb.h"
#include "edge/publisher/renewable_publisher.h"
#include "edge/recording_server/recording_server.h"
#include "edge/spool/recording_files.h"
#include "edge/spool/recording_name.h"

namespace isotherm {
namespace {

using std::chrono::milliseconds;

/// Everything else goes first.
constexpr int kNiceness = 10;

int Fail(const Status& status) {
  LOG(Edge, Error) << status.message();
  return ExitCode(status);
}

/// The configured calibration file; nullopt if none is.
Result<std::optional<Rig>> LoadCalibration(const SourceOptions& options) {
  if (options.rig_file().empty()) return std::nullopt;
  Result<Rig> rig = LoadRigCalibration(options.rig_file());
  if (!rig) return Err(rig.error());
  return std::optional<Rig>(std::move(*rig));
}

/// Says what of the configured file is old or uncertain.
void LogRecords(const SourceOptions& options, CaptureTime now) {
  RigCalibration file;
  if (options.rig_file().empty() || !LoadTextProto(options.rig_file(), file).ok()) return;
  const std::chrono::sys_days today(std::chrono::floor<std::chrono::days>(now.time_since_epoch()));
  for (const std::string& doubt :
       DoubtsAboutRecords(file, today, {.max_age_days = options.rig_max_age_days()}))
    LOG(Edge, Warning) << doubt;
}

/// Says what is missing for temperatures on the surface.
void LogRig(const std::optional<Rig>& rig) {
  if (!rig) {
    LOG(Edge, Warning) << "no rig calibration: thermal frames cannot be fused with depth";
    return;
  }
  for (const std::string& doubt : DoubtsAbout(*rig)) LOG(Edge, Warning) << doubt;
  if (const Status fusion = CheckThermalFusion(*rig); !fusion.ok()) {
    LOG(Edge, Warning) << "thermal frames cannot be fused with depth: " << fusion.message()
                       << "; name a calibration with --rig";
  }
  if (rig->method.starts_with("nominal")) {
    LOG(Edge, Warning) << "intrinsics of the depth camera are " << rig->method
                       << ", fx=" << rig->depth->fx << " fy=" << rig->depth->fy;
  }
}

/// Says it at the start, not when the scan is over.
void LogCounts(const std::vector<CameraDescription>& cameras) {
  for (const CameraDescription& camera : cameras) {
    if (!camera.counts_only) continue;
    LOG(Edge, Warning)
        << "the thermal camera (" << camera.driver
        << ") sends counts, not temperatures: they are recorded and published as "
           "that, and the surface will have no temperatures; "
           "source.thermal_camera.expert.kelvin_per_count and offset_kelvin could say what "
           "counts mean";
  }
}

/// A replay that keeps its own times does not care.
void LogClock(const EdgeOptions& options, const KernelClock& clock) {
  if (TimeBaseOf(options.source()) != TimeBase::kWallClock) return;
  if (const std::optional<std::string> problem = ClockProblem(clock)) {
    LOG(Edge, Warning) << *problem;
  }
}

/// Null if nothing is to be recorded. Without a disk it waits for one, unless somebody waits for
/// the end of the source: then that is an error.
Result<std::unique_ptr<Spool>> MakeSpool(const EdgeOptions& options, const EdgeSession& start,
                                         const std::optional<InterruptedScan>& before,
                                         const Clock& clock, FrameCounters& counters) {
  const std::optional<std::filesystem::path> path =
      before ? before->path : RecordingPath(options.spool().record(), start.time, start.session());
  if (!path) return nullptr;
  const auto files = std::make_shared<RecordingFiles>(RecordingDescription{
      *path, FromSeconds(options.spool().expert().flush_interval_s()), start.rig,
      RecordingMetadata(options, start), before ? before->parts : 0, /*sync=*/true, &clock});
  auto spool = std::make_unique<Spool>(SpoolParts{
      [files] { return files->Next(); }, [path] { return FreeDiskBytes(*path); }, options.spool(),
      clock, counters, [files](const RigUpdate& update) { files->Update(update); },
      before ? &*before : nullptr,
      [record = options.spool().record()] { return RecordingsSize(record); },
      [record = options.spool().record(), path] { return FetchedSize(record, *path); },
      [record = options.spool().record(), path] { return DeleteOldestFetched(record, *path); },
      [record = options.spool().record(), path] { return DeleteOldestFile(record, *path); }});
  if (options.spool().when_full() == DELETE_FETCHED && *path == options.spool().record()) {
    LOG(Edge, Warning)
        << "spool.when_full=DELETE_FETCHED deletes nothing, because spool.record names "
           "a file: name a folder";
  }
  if (options.exit_at_end()) {
    if (Status begun = spool->Begin(); !begun.ok()) return Err(begun);
  }
  return spool;
}

Result<std::unique_ptr<Publisher>> MakePublisher(const EdgeOptions& options,
                                                 const Participant& participant,
                                                 const Clock& clock) {
  PublisherOptions publisher;
  publisher.edge_id = options.link().edge_id();
  publisher.software_version = ISOTHERM_VERSION;
  publisher.pieces = options.link().expert().pieces();
  const bool is_paced = options.source().rate() != 0.0;
  const bool is_backfilled =
      options.spool().record() != "off" && options.link().expert().backfill_hz() > 0.0;
  publisher.leaves_whole_frames = publisher.pieces && is_paced && is_backfilled;
  const bool lossless = options.link().policy() == LOSSLESS || !is_paced;
  publisher.policy = lossless ? PublishPolicy::kLossless : PublishPolicy::kLive;
  return Publisher::Create(participant, clock, publisher);
}

/// Holds a participant and what speaks through it; it must outlive the others.
struct Link {
  std::unique_ptr<Participant> participant;
  std::unique_ptr<RecordingServer> server;  ///< Null without recordings.
  std::unique_ptr<Publisher> publisher;
};

/// Holds what outlives scans and link.
struct Process {
  ServedState state;
  /// Completes recordings of processes before; nobody waits for it but the end.
  std::jthread completing;
};

/// Gives away recordings from now on. A scan does not end because it cannot.
void ServeRecordings(const EdgeOptions& options, const ServedState& state, Link& link) {
  const double rate_mb_per_s = options.link().expert().fetch_mb_per_s();
  if (options.spool().record() == "off" || rate_mb_per_s <= 0.0) return;
  Result<std::unique_ptr<RecordingServer>> server = RecordingServer::Start(
      *link.participant, {options.link().edge_id(), options.spool().record(), 1e6 * rate_mb_per_s},
      state);
  if (!server) {
    LOG(Edge, Warning) << "recordings cannot be fetched: " << server.error().message();
    return;
  }
  link.server = std::move(*server);
}

/// Returns the publisher of a new link, which it keeps alive.
Result<std::shared_ptr<Publisher>> MakeLink(const EdgeOptions& options,
                                            std::unique_ptr<Participant> participant,
                                            const Clock& clock, const ServedState& state) {
  const auto link = std::make_shared<Link>();
  link->participant = std::move(participant);
  Result<std::unique_ptr<Publisher>> made = MakePublisher(options, *link->participant, clock);
  if (!made) return Err(made.error());
  link->publisher = std::move(*made);
  ServeRecordings(options, state, *link);
  return std::shared_ptr<Publisher>(link, link->publisher.get());
}

/// Without a network it captures and records all the same, unless somebody waits for the end of
/// the source.
Result<std::unique_ptr<Publisher>> Connect(const EdgeOptions& options,
                                           const TransportEnvironment& environment,
                                           const Clock& clock, const ServedState& state) {
  const int domain = options.link().domain();
  const Announcement announcement{Role::kEdge, options.link().edge_id(), HostName()};
  auto publisher = std::make_unique<RenewablePublisher>(
      [&options, &environment, &clock, &state, domain, announcement](
          const std::stop_token& stop,
          const RenewablePublisher::Waiting& waiting) -> Result<std::shared_ptr<Publisher>> {
        Result<std::unique_ptr<Participant>> late =
            JoinDomain(environment, domain, clock, stop, waiting, announcement);
        if (!late) return Err(late.error());
        return MakeLink(options, std::move(*late), clock, state);
      },
      &NetworkAddresses, clock);
  std::string addresses = NetworkAddresses();
  Result<std::unique_ptr<Participant>> joined =
      Participant::Create(environment, domain, announcement);
  if (joined) {
    Result<std::shared_ptr<Publisher>> link = MakeLink(options, std::move(*joined), clock, state);
    if (!link) return Err(link.error());
    publisher->Start(std::move(*link), std::move(addresses));
  } else if (options.exit_at_end() || joined.error().code() != StatusCode::kUnavailable) {
    return Err(joined.error());
  }
  return publisher;
}

/// Gives the files that the processes before have left an index. A file that is not completed when
/// the process leaves is readable as it is.
std::jthread CompleteInBackground(const InterruptedScan& before, ServedState& state) {
  std::vector<std::filesystem::path> files;
  for (const RecordedRun& run : before.runs) {
    if (files.empty() || files.back() != run.file) files.push_back(run.file);
  }
  state.is_completing = true;
  // Of a file of hours all of the disk may have to be looked at.
  return std::jthread([files = std::move(files), &state](const std::stop_token& stop) {
    NameThread("complete");
    LowerThreadPriority(kNiceness);
    for (const std::filesystem::path& file : files) {
      if (stop.stop_requested()) break;
      const auto cut = CompleteRecording(file);
      if (!cut && cut.error().code() == StatusCode::kNotFound) continue;  // Deleted meanwhile.
      if (!cut) {
        LOG(Edge, Warning) << cut.error().message() << "; it is readable as it is";
      } else if (*cut) {
        LOG(Edge, Info) << file.string() << " has broken off, and is completed";
      }
    }
    state.is_completing = false;
  });
}

/// Returns whether the first scan waits for its order. One that was interrupted had its own.
bool IsToWait(const EdgeOptions& options, const Clock& clock) {
  return options.link().wait_for_order() &&
         !FindInterruptedScan(options.spool().record(), options.link().edge_id(), clock.Now(),
                              FromSeconds(options.spool().resume_s()));
}

/// Opens the source and runs a scan of it. Joins the link if that has not been done.
CaptureEnd RunScan(const EdgeOptions& options, const TransportEnvironment& environment,
                   const Clock& clock, const std::optional<Rig>& calibration,
                   const std::stop_token& stop, Leaving& leaving, Process& process,
                   std::unique_ptr<Publisher>& link) {
  process.completing.request_stop();  // The scan has the disk for itself.
  FrameCounters counters;
  CameraHealth health;
  const Result<std::unique_ptr<FrameSource>> source =
      OpenSource(options, {clock, counters, health, calibration, stop});
  if (!source) return {.status = stop.stop_requested() ? 0 : Fail(source.error())};
  const std::optional<Rig> rig = calibration ? calibration : (*source)->rig();
  LogRig(rig);
  LogCounts((*source)->cameras());
  EdgeSession session{.time = clock.Now(),
                      .cameras = (*source)->cameras(),
                      .rig = AsPublished(rig, **source),
                      .rig_thermal_delay_s = rig ? rig->thermal_delay_s : 0.0,
                      .clock = ReadKernelClock()};
  LogClock(options, session.clock);
  // Only a process's first scan can be one that another process has begun; then it did not wait.
  std::optional<InterruptedScan> before;
  if (!link) before = FindScanToResume(options, session);
  if (before) {
    Resume(*before, session);
    CountBefore(*before, session, counters);
  } else if (!link && options.link().wait_for_order()) {
    // What seemed to be interrupted cannot be gone on with.
    return {.another_scan = true};
  }

  if (!link) {
    auto connected = Connect(options, environment, clock, process.state);
    if (!connected) return {.status = Fail(connected.error())};
    link = std::move(*connected);
  }
  Result<std::unique_ptr<Spool>> spool = MakeSpool(options, session, before, clock, counters);
  if (!spool) {
    LOG(Edge, Error) << spool.error().message();
    return {.status = kExitRecording};
  }
  const auto on_idle = [&before, &process] {
    if (before) process.completing = CompleteInBackground(*before, process.state);
  };
  const Status begun = link->BeginSession(DescribeRig(options, session),
                                          before ? PublishedBy(*before, session) : SessionBefore());
  if (!begun.ok()) return {.status = Fail(begun)};
  return Capture({options, session, **source, counters, health, *link, leaving,
                  process.state.is_scanning, on_idle, clock, stop},
                 std::move(*spool));
}

}  // namespace

int RunEdge(const EdgeOptions& options, const TransportEnvironment& environment, const Clock& clock,
            const StopSignal& signal) {
  const std::stop_token stop = signal.token();
  Leaving leaving;  // Outlives what may not end.
  const std::stop_callback on_signal(stop, [&leaving] {
    leaving.deadline.Bound(stop_limits::kTotal);
    leaving.deadline.ArmFirst(stop_limits::kDisk, leaving.status_if_stuck, "what was under way");
  });
  const Result<std::optional<Rig>> calibration = LoadCalibration(options.source());
  LogRecords(options.source(), clock.Now());
  if (!calibration) return Fail(calibration.error());
  Process process;
  CaptureEnd end{.another_scan = true};
  {
    std::unique_ptr<Publisher> link;
    bool waits = IsToWait(options, clock);
    while (end.another_scan) {
      if (waits) {
        auto connected = Connect(options, environment, clock, process.state);
        if (!connected) return Fail(connected.error());
        link = std::move(*connected);
        if (!WaitForScanOrder(*link, clock, stop)) return 0;
      }
      const CaptureEnd scan =
          RunScan(options, environment, clock, *calibration, stop, leaving, process, link);
      end = {end.status != 0 ? end.status : scan.status, scan.another_scan};
      waits = !link && options.link().wait_for_order();
    }
  }
  // The link has ended in its own time.
  if (process.state.is_completing)
    leaving.deadline.Arm(stop_limits::kDisk, end.status, "a recording that is completed");
  return end.status;
}

}  // namespace isotherm
