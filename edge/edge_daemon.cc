#include "edge/edge_daemon.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <memory>
#include <optional>
#include <utility>

#include "common/base/log.h"
#include "common/config/text_proto.h"
#include "edge/edge_options.pb.h"
#include "edge/edge_pipeline.h"
#include "edge/edge_report.h"
#include "edge/housekeeping.h"
#include "edge/source/pause.h"
#include "edge/source/replay_source.h"
#include "edge/source/supervised_source.h"
#include "edge/source/synthetic_source.h"

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

std::unique_ptr<SupervisedSource> MakeSource(const EdgeOptions& options, const Clock& clock,
                                             FrameAccount& account, const std::stop_token& stop) {
  std::unique_ptr<FrameSource> source;
  if (options.source().kind() == REPLAY) {
    source = std::make_unique<ReplaySource>(options.source(), options.source().recording(), clock);
  } else {
    source = std::make_unique<SyntheticSource>(options.source(), clock, stop);
  }
  const auto count_as = [&account](FrameFate fate) {
    return [fate, &account](Sensor sensor) { account.Count(sensor, fate); };
  };
  return std::make_unique<SupervisedSource>(std::move(source), options.frame_check(), clock,
                                            count_as(FrameFate::kCaptured),
                                            count_as(FrameFate::kRejected));
}

/// The configured calibration file, or what comes with the source; nullopt if there is none.
Result<std::optional<Rig>> ChooseRig(const SourceOptions& options, SupervisedSource& source) {
  if (options.rig_file().empty()) return source.rig();
  Result<Rig> rig = LoadRigCalibration(options.rig_file());
  if (!rig) return Err(rig.error());
  source.Expect(*rig);
  return std::optional<Rig>(std::move(*rig));
}

/// The rig as it is published and recorded: capture times already contain the thermal delay.
std::optional<Rig> WithoutThermalDelay(std::optional<Rig> rig) {
  if (rig) rig->thermal_delay_s = 0.0;
  return rig;
}

/// What was found out before anything starts.
struct Start {
  CaptureTime time;
  std::optional<Rig> rig;            ///< As published and recorded.
  double rig_thermal_delay_s = 0.0;  ///< As calibrated.

  /// One per start of a scan.
  std::uint64_t session() const { return static_cast<std::uint64_t>(ToNanoseconds(time)); }
};

RigDescription Describe(const EdgeOptions& options, const Start& start) {
  RigDescription description;
  description.session = start.session();
  description.waits_for_ground = options.source().rate() == 0.0;
  if (!start.rig) return description;
  description.rig = *start.rig;
  const auto mode = [](const std::optional<CameraModel>& camera, Encoding encoding) {
    StreamMode stream;
    if (camera) stream = {camera->width, camera->height, 0.0, encoding, ""};
    return stream;
  };
  description.depth = mode(start.rig->depth, Encoding::kDepthRans);
  description.thermal = mode(start.rig->thermal, Encoding::kThermalRans);
  return description;
}

Result<std::unique_ptr<Spool>> OpenSpool(const EdgeOptions& options, const Start& start,
                                         FrameAccount& account) {
  const std::optional<std::filesystem::path> path = SpoolPath(options.spool().record(), start.time);
  if (!path) return nullptr;
  const TimestamperOptions& timing = options.timestamper();
  const Spool::Metadata metadata = {
      {"configuration", {{"edge", ToTextProto(options)}}},
      {"software", {{"name", "isotherm-edge"}, {"version", ISOTHERM_VERSION}}},
      {"timing",
       {{"depth_delay_s", fmt::format("{}", timing.depth_delay_s())},
        {"thermal_delay_s",
         fmt::format("{}", timing.thermal_delay_s() + start.rig_thermal_delay_s)}}}};
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
int Capture(const EdgeOptions& options, const Start& start, SupervisedSource& source,
            std::unique_ptr<Spool> spool, FrameAccount& account, Publisher& publisher,
            const Clock& clock, const std::stop_token& stop) {
  const bool recording = spool != nullptr;
  const std::filesystem::path disk = recording ? spool->path() : ".";
  EdgePipeline pipeline(options, {source, publisher, account, clock, std::move(spool),
                                  start.session(), start.rig_thermal_delay_s});
  pipeline.StartReceiving();
  NotifyReady(fmt::format("capturing from {}", source.name()));
  LOG(Edge, Info) << "started: " << source.name() << ", edge_id=" << options.link().edge_id()
                  << " domain=" << options.link().domain() << " session=" << start.session();
  if (options.link().wait_for_ground()) WaitForGround(publisher, stop);

  pipeline.StartCapture();
  Housekeeping housekeeping(clock, pipeline, publisher, account, disk,
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
  return recorded.ok() ? 0 : kExitRecording;
}

}  // namespace

int RunEdge(const EdgeOptions& options, const TransportEnvironment& environment, const Clock& clock,
            const StopSignal& signal) {
  const std::stop_token stop = signal.token();
  FrameAccount account;
  const std::unique_ptr<SupervisedSource> source = MakeSource(options, clock, account, stop);
  if (const Status opened = source->Open(); !opened.ok()) {
    return stop.stop_requested() ? 0 : Fail(opened);
  }
  const Result<std::optional<Rig>> rig = ChooseRig(options.source(), *source);
  if (!rig) return Fail(rig.error());
  if (!*rig) {
    LOG(Edge, Warning) << "no rig calibration: thermal frames cannot be fused with depth";
  }
  const Start start{clock.Now(), WithoutThermalDelay(*rig), *rig ? (*rig)->thermal_delay_s : 0.0};

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
  return Capture(options, start, *source, std::move(*spool), account, **publisher, clock, stop);
}

}  // namespace isotherm
