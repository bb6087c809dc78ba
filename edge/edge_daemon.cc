#include "edge/edge_daemon.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "common/base/log.h"
#include "common/codec/codec.h"
#include "common/config/text_proto.h"
#include "common/transport/clock_record.h"
#include "edge/edge_options.pb.h"
#include "edge/edge_pipeline.h"
#include "edge/edge_report.h"
#include "edge/housekeeping.h"
#include "edge/make_source.h"
#include "edge/source/pause.h"

namespace isotherm {
namespace {

using std::chrono::milliseconds;

// How often the main thread looks around.
constexpr Nanoseconds kTick = milliseconds(50);
// Time to let the ground confirm the last frames when a signal says to leave.
constexpr Nanoseconds kLingerAfterSignal = milliseconds(500);

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
void TellAboutRig(const std::optional<Rig>& rig) {
  if (!rig) {
    LOG(Edge, Warning) << "no rig calibration: thermal frames cannot be fused with depth";
    return;
  }
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
void TellAboutCounts(const std::vector<CameraDescription>& cameras) {
  for (const CameraDescription& camera : cameras) {
    if (!camera.counts_only) continue;
    LOG(Edge, Warning) << "the thermal camera (" << camera.driver
                       << ") sends counts, not temperatures: they are recorded and published as "
                          "that, and the surface will have no temperatures; "
                          "source.thermal_camera.kelvin_per_count and offset_kelvin could say what "
                          "counts mean";
  }
}

/// A replay that keeps its own times does not care.
void TellAboutClock(const EdgeOptions& options, const KernelClock& clock) {
  if (TimeBaseOf(options.source()) != TimeBase::kWallClock) return;
  if (const std::optional<std::string> problem = ClockProblem(clock)) {
    LOG(Edge, Warning) << *problem;
  }
}

/// The rig as it is published and recorded: capture times already contain the thermal delay.
std::optional<Rig> WithoutThermalDelay(std::optional<Rig> rig) {
  if (rig) rig->thermal_delay_s = 0.0;
  return rig;
}

/// What was found out before anything starts.
struct Start {
  CaptureTime time;
  std::vector<CameraDescription> cameras;
  std::optional<Rig> rig;            ///< As published and recorded.
  double rig_thermal_delay_s = 0.0;  ///< As calibrated.
  KernelClock clock;

  /// One per start of a scan.
  std::uint64_t session() const { return static_cast<std::uint64_t>(ToNanoseconds(time)); }
};

/// "lepton-uvc, PureThermal".
std::string ModelText(const CameraDescription& camera) {
  return fmt::format("{}, {}", camera.driver, camera.model);
}

Encoding EncodingOf(const CameraDescription& camera) {
  if (camera.sensor == Sensor::kDepth) return Encoding::kDepthRans;
  return camera.counts_only ? Encoding::kCounts16 : Encoding::kThermalRans;
}

RigDescription Describe(const EdgeOptions& options, const Start& start) {
  RigDescription description;
  description.session = start.session();
  description.waits_for_ground = options.source().rate() == 0.0;
  if (start.rig) description.rig = *start.rig;
  const auto mode = [](const std::optional<CameraModel>& camera, Encoding encoding) {
    StreamMode stream;
    if (camera) stream = {camera->width, camera->height, 0.0, encoding, "", ""};
    return stream;
  };
  description.depth = mode(description.rig.depth, Encoding::kDepthRans);
  description.thermal = mode(description.rig.thermal, Encoding::kThermalRans);
  for (const CameraDescription& camera : start.cameras) {
    StreamMode& stream = camera.sensor == Sensor::kDepth ? description.depth : description.thermal;
    stream = {camera.width,       camera.height, camera.rate_hz,
              EncodingOf(camera), camera.serial, ModelText(camera)};
  }
  return description;
}

/// What the recording says of the cameras.
std::map<std::string, std::string> CameraMetadata(const std::vector<CameraDescription>& cameras) {
  std::map<std::string, std::string> metadata;
  for (const CameraDescription& camera : cameras) {
    const std::string name = camera.sensor == Sensor::kDepth ? "depth" : "thermal";
    metadata[name] = ModelText(camera);
    metadata[name + "_serial"] = camera.serial;
    metadata[name + "_mode"] =
        fmt::format("{}x{}@{:g}", camera.width, camera.height, camera.rate_hz);
    metadata[name + "_settings"] = camera.settings;
  }
  return metadata;
}

Result<std::unique_ptr<Spool>> OpenSpool(const EdgeOptions& options, const Start& start,
                                         FrameAccount& account) {
  const std::optional<std::filesystem::path> path = SpoolPath(options.spool().record(), start.time);
  if (!path) return nullptr;
  const TimestamperOptions& timing = options.timestamper();
  Spool::Metadata metadata = {
      {"configuration", {{"edge", ToTextProto(options)}}},
      {"software", {{"name", "isotherm-edge"}, {"version", ISOTHERM_VERSION}}},
      {std::string(kClockMetadata), ClockMetadata(start.clock, TimeBaseOf(options.source()))},
      {"timing",
       {{"depth_delay_s", fmt::format("{}", timing.depth_delay_s())},
        {"thermal_delay_s",
         fmt::format("{}", timing.thermal_delay_s() + start.rig_thermal_delay_s)}}}};
  if (!start.cameras.empty()) metadata["cameras"] = CameraMetadata(start.cameras);
  LOG(Edge, Info) << "recording to " << path->string();
  return Spool::Create(*path, options.spool(), start.rig, metadata, account);
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
  while (!publisher.Drain(kTick)) {
    const Nanoseconds configured = FromSeconds(options.linger_s());
    const Nanoseconds limit =
        stop.stop_requested() ? std::min(configured, kLingerAfterSignal) : configured;
    if (clock.SteadyNow() - start >= limit) return false;
  }
  return true;
}

void RunUntilStopped(const EdgeOptions& options, EdgePipeline& pipeline, Housekeeping& housekeeping,
                     const std::stop_token& stop) {
  bool told = false;
  while (!stop.stop_requested()) {
    housekeeping.Tick();
    if (pipeline.finished()) {
      if (options.exit_at_end()) return;
      if (!std::exchange(told, true)) {
        LOG(Edge, Info) << "the source has ended; waiting for a signal to leave";
      }
    }
    Pause(stop, kTick);
  }
}

/// Captures until told to leave, then hands on what is under way. The process's exit status.
int Capture(const EdgeOptions& options, const Start& start, FrameSource& source,
            std::unique_ptr<Spool> spool, FrameAccount& account, CameraHealth& health,
            Publisher& publisher, const Clock& clock, const std::stop_token& stop) {
  const bool recording = spool != nullptr;
  const std::filesystem::path disk = recording ? spool->path() : ".";
  EdgePipeline pipeline(options, {source, publisher, account, health, clock, std::move(spool),
                                  start.session(), start.rig_thermal_delay_s});
  pipeline.StartReceiving();
  NotifyReady(fmt::format("capturing from {}", source.name()));
  LOG(Edge, Info) << "started: " << source.name() << ", edge_id=" << options.link().edge_id()
                  << " domain=" << options.link().domain() << " session=" << start.session();
  if (options.link().wait_for_ground()) WaitForGround(publisher, stop);

  pipeline.StartCapture();
  Housekeeping housekeeping(clock, pipeline, publisher, account, health, disk,
                            options.display().picture_file());
  RunUntilStopped(options, pipeline, housekeeping, stop);

  NotifyStopping();
  const Status recorded = pipeline.Stop();
  housekeeping.PublishEnd();
  if (!Drain(publisher, options.link(), clock, stop)) {
    LOG(Edge, Warning) << "the ground did not confirm all frames before the end";
  }
  std::fputs(
      Summary(account, recording, publisher.receipt(), pipeline.feedback().latency()).c_str(),
      stdout);
  std::fputs(CameraSummary(health.Get(Sensor::kDepth), health.Get(Sensor::kThermal)).c_str(),
             stdout);
  return recorded.ok() ? 0 : kExitRecording;
}

}  // namespace

int RunEdge(const EdgeOptions& options, const TransportEnvironment& environment, const Clock& clock,
            const StopSignal& signal) {
  const std::stop_token stop = signal.token();
  FrameAccount account;
  CameraHealth health;
  const Result<std::optional<Rig>> calibration = LoadCalibration(options.source());
  if (!calibration) return Fail(calibration.error());
  const Result<std::unique_ptr<FrameSource>> source =
      MakeSource(options, {clock, account, health, *calibration, stop});
  if (!source) return Fail(source.error());
  if (const Status opened = (*source)->Open(); !opened.ok()) {
    return stop.stop_requested() ? 0 : Fail(opened);
  }
  const std::optional<Rig> rig = *calibration ? *calibration : (*source)->rig();
  TellAboutRig(rig);
  TellAboutCounts((*source)->cameras());
  const Start start{clock.Now(), (*source)->cameras(), WithoutThermalDelay(rig),
                    rig ? rig->thermal_delay_s : 0.0, ReadKernelClock()};
  TellAboutClock(options, start.clock);

  const Result<std::unique_ptr<Participant>> participant =
      Participant::Create(environment, options.link().domain());
  if (!participant) return Fail(participant.error());
  const Result<std::unique_ptr<Publisher>> publisher = MakePublisher(options, **participant, clock);
  if (!publisher) return Fail(publisher.error());
  Result<std::unique_ptr<Spool>> spool = OpenSpool(options, start, account);
  if (!spool) {
    LOG(Edge, Error) << spool.error().message();
    return kExitRecording;
  }
  const Status begun = (*publisher)->BeginSession(Describe(options, start));
  if (!begun.ok()) return Fail(begun);
  return Capture(options, start, **source, std::move(*spool), account, health, **publisher, clock,
                 stop);
}

}  // namespace isotherm
