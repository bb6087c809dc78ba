#include "edge/daemon/edge_daemon.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cstdio>
#include <functional>
#include <memory>
#include <optional>
#include <stop_token>
#include <string>
#include <utility>
#include <vector>

#include "common/base/exit_deadline.h"
#include "common/base/log.h"
#include "common/base/pause.h"
#include "common/base/processor_time.h"
#include "common/doubts/doubts.h"
#include "common/rig/rig_calibration.h"
#include "common/transport/join_domain.h"
#include "edge/daemon/edge_monitor.h"
#include "edge/daemon/edge_report.h"
#include "edge/daemon/host_status.h"
#include "edge/daemon/open_source.h"
#include "edge/daemon/rig_announcer.h"
#include "edge/daemon/session_start.h"
#include "edge/daemon/stop_limits.h"
#include "edge/options/edge_options.pb.h"
#include "edge/pipeline/edge_pipeline.h"
#include "edge/publisher/late_publisher.h"
#include "edge/spool/recording_files.h"
#include "edge/spool/recording_name.h"

namespace isotherm {
namespace {

using std::chrono::milliseconds;

// EX_CANTCREAT of sysexits.h: the recording could not be created or not be finished.
constexpr int kExitRecording = 73;

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
                                         const Clock& clock, FrameCounters& counters) {
  const std::optional<std::filesystem::path> path =
      RecordingPath(options.spool().record(), start.time, start.session());
  if (!path) return nullptr;
  const auto files = std::make_shared<RecordingFiles>(
      RecordingDescription{*path, FromSeconds(options.spool().expert().flush_interval_s()),
                           start.rig, RecordingMetadata(options, start)});
  auto spool = std::make_unique<Spool>(SpoolParts{
      [files] { return files->Next(); }, [path] { return FreeDiskBytes(*path); }, options.spool(),
      clock, counters, [files](const RigUpdate& update) { files->Update(update); }});
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
  const bool lossless = options.link().policy() == LOSSLESS || options.source().rate() == 0.0;
  publisher.policy = lossless ? PublishPolicy::kLossless : PublishPolicy::kLive;
  return Publisher::Create(participant, clock, publisher);
}

void WaitForGround(Publisher& publisher, const std::stop_token& stop) {
  LOG(Edge, Info) << "waiting for a ground station";
  while (!stop.stop_requested() && !publisher.WaitForGround(milliseconds(500), stop)) {
    NotifyWatchdog();
  }
}

/// Lets the ground confirm what was sent. False if it did not in time.
bool Drain(Publisher& publisher, const LinkOptions& options, const Clock& clock,
           const std::stop_token& stop) {
  const SteadyTime start = clock.SteadyNow();
  while (!publisher.Drain(stop_limits::kTick)) {
    const Nanoseconds configured = FromSeconds(options.expert().linger_s());
    const Nanoseconds limit =
        stop.stop_requested() ? std::min(configured, stop_limits::kLingerAfterSignal) : configured;
    if (clock.SteadyNow() - start >= limit) return false;
  }
  return true;
}

void RunUntilStopped(const EdgeOptions& options, EdgePipeline& pipeline, EdgeMonitor& monitor,
                     RigAnnouncer& announcer, const std::stop_token& stop) {
  bool told = false;
  while (!stop.stop_requested()) {
    monitor.Tick();
    announcer.Tick();
    if (pipeline.finished()) {
      if (options.exit_at_end()) return;
      if (!std::exchange(told, true)) {
        LOG(Edge, Info) << "the source has ended; waiting for a signal to leave";
      }
    }
    Pause(stop, stop_limits::kTick);
  }
}

/// Ends the process in time once it was told to leave, whatever it is at then.
struct Leaving {
  ExitDeadline deadline;
  std::atomic<int> status_if_stuck{0};
};

/// Holds what a capture works with from its beginning to its end.
struct CaptureParts {
  const EdgeOptions& options;
  const EdgeSession& session;
  FrameSource& source;
  FrameCounters& counters;
  CameraHealth& health;
  Publisher& publisher;
  Leaving& leaving;
  const Clock& clock;
  const std::stop_token& stop;
};

/// Holds what had been used when a capture began.
struct CaptureBegin {
  SteadyTime time;
  ProcessorTimes processor;
};

/// Returns what the capture has cost, to be asked for while its threads still live.
std::string ProcessorText(const CaptureBegin& begin, SteadyTime now) {
  return "processor " + ToText(ReadProcessorTimes() - begin.processor, ToSeconds(now - begin.time));
}

/// Completes that, once the processes of cameras have ended.
void PrintProcessorText(const std::string& text) {
  const double cameras_s = ProcessorTimeOfChildren_s();
  std::fputs(text.c_str(), stdout);
  std::fputs(
      cameras_s > 0.0 ? fmt::format("; processes of cameras {:.1f} s\n", cameras_s).c_str() : "\n",
      stdout);
  std::fflush(stdout);
}

void PrintSummary(const CaptureParts& parts, const EdgePipeline& pipeline, bool recording) {
  std::fputs(
      Summary(parts.counters, recording, parts.publisher.receipt(), pipeline.feedback().latency())
          .c_str(),
      stdout);
  std::fputs(
      CameraSummary(parts.health.Get(Sensor::kDepth), parts.health.Get(Sensor::kThermal)).c_str(),
      stdout);
  std::fflush(stdout);
}

/// Ends the recording, then the link, each in its time; `say` tells what was done. The process's
/// exit status.
int Leave(const CaptureParts& parts, EdgePipeline& pipeline, EdgeMonitor& monitor,
          const std::function<void()>& say) {
  ExitDeadline& deadline = parts.leaving.deadline;
  const LinkOptions& link = parts.options.link();
  // With a signal the time already runs.
  deadline.ArmFirst(stop_limits::kCameras + stop_limits::kDisk, kExitRecording, "a camera", say);
  const bool cameras_ended = pipeline.StopCapture(stop_limits::kCameras);
  if (!cameras_ended) {
    LOG(Edge, Error) << "a camera did not end within " << ToSeconds(stop_limits::kCameras)
                     << " s; leaving without it";
  }
  deadline.Arm(stop_limits::kDisk, kExitRecording, "the disk", say);
  const int status = pipeline.StopRecording().ok() ? 0 : kExitRecording;
  const Nanoseconds linger =
      parts.stop.stop_requested() ? Nanoseconds(0) : FromSeconds(link.expert().linger_s());
  deadline.Arm(stop_limits::kLink + linger, status, "the network", say);
  static_cast<void>(pipeline.Stop());
  monitor.PublishEnd();
  if (!Drain(parts.publisher, link, parts.clock, parts.stop)) {
    LOG(Edge, Warning) << "the ground did not confirm all frames before the end";
  }
  deadline.Arm(stop_limits::kMiddleware, status,
               cameras_ended ? "the middleware or standard output" : "a camera");
  say();
  return status;
}

/// Captures until told to leave, then passes on what is under way. The process's exit status.
int Capture(const CaptureParts& parts, std::unique_ptr<Spool> spool) {
  const auto& [options, session, source, counters, health, publisher, leaving, clock, stop] = parts;
  const bool recording = spool != nullptr;
  if (recording) leaving.status_if_stuck = kExitRecording;
  const CaptureBegin begin{clock.SteadyNow(), ReadProcessorTimes()};
  EdgePipeline pipeline(options, {source, publisher, counters, health, clock, std::move(spool),
                                  session.session(), session.rig_thermal_delay_s});
  pipeline.StartReceiving();
  NotifyReady(fmt::format("capturing from {}", source.name()));
  LOG(Edge, Info) << "started: " << source.name() << ", edge_id=" << options.link().edge_id()
                  << " domain=" << options.link().domain() << " session=" << session.session();
  if (options.link().wait_for_ground()) WaitForGround(publisher, stop);

  pipeline.StartCapture();
  EdgeMonitor monitor({clock, pipeline, publisher, counters, health},
                      options.display().image_file());
  RigAnnouncer announcer(options, session, health, publisher,
                         [&pipeline](RigUpdate update) { pipeline.RecordRig(std::move(update)); });
  RunUntilStopped(options, pipeline, monitor, announcer, stop);
  NotifyStopping();
  return Leave(parts, pipeline, monitor,
               [&parts, &pipeline, recording, processor = ProcessorText(begin, clock.SteadyNow())] {
                 PrintSummary(parts, pipeline, recording);
                 PrintProcessorText(processor);
               });
}

/// A participant and what publishes through it; the first must outlive the second.
struct Link {
  std::unique_ptr<Participant> participant;
  std::unique_ptr<Publisher> publisher;
};

/// Without a network it captures and records all the same, unless somebody waits for the end of
/// the source. `link` must stay where it is.
Status Connect(const EdgeOptions& options, const TransportEnvironment& environment,
               const Clock& clock, Link& link) {
  const int domain = options.link().domain();
  Result<std::unique_ptr<Participant>> joined = Participant::Create(environment, domain);
  if (joined) {
    link.participant = std::move(*joined);
    Result<std::unique_ptr<Publisher>> made = MakePublisher(options, *link.participant, clock);
    if (!made) return made.error();
    link.publisher = std::move(*made);
    return OkStatus();
  }
  if (options.exit_at_end() || joined.error().code() != StatusCode::kUnavailable) {
    return joined.error();
  }
  link.publisher = std::make_unique<LatePublisher>(
      [&options, &environment, &clock, &link, domain](
          const std::stop_token& stop,
          const LatePublisher::Waiting& waiting) -> Result<std::unique_ptr<Publisher>> {
        Result<std::unique_ptr<Participant>> late =
            JoinDomain(environment, domain, clock, stop, waiting);
        if (!late) return Err(late.error());
        link.participant = std::move(*late);
        return MakePublisher(options, *link.participant, clock);
      });
  return OkStatus();
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
  FrameCounters counters;
  CameraHealth health;
  const Result<std::optional<Rig>> calibration = LoadCalibration(options.source());
  if (!calibration) return Fail(calibration.error());
  const Result<std::unique_ptr<FrameSource>> source =
      OpenSource(options, {clock, counters, health, *calibration, stop});
  if (!source) return stop.stop_requested() ? 0 : Fail(source.error());
  const std::optional<Rig> rig = *calibration ? *calibration : (*source)->rig();
  LogRig(rig);
  LogCounts((*source)->cameras());
  const EdgeSession start{clock.Now(), (*source)->cameras(), AsPublished(rig, **source),
                          rig ? rig->thermal_delay_s : 0.0, ReadKernelClock()};
  LogClock(options, start.clock);

  Link link;
  if (const Status connected = Connect(options, environment, clock, link); !connected.ok()) {
    return Fail(connected);
  }
  Result<std::unique_ptr<Spool>> spool = MakeSpool(options, start, clock, counters);
  if (!spool) {
    LOG(Edge, Error) << spool.error().message();
    return kExitRecording;
  }
  const Status begun = link.publisher->BeginSession(DescribeRig(options, start));
  if (!begun.ok()) return Fail(begun);
  return Capture(
      {options, start, **source, counters, health, *link.publisher, leaving, clock, stop},
      std::move(*spool));
}

}  // namespace isotherm
