#include "edge/daemon/make_source.h"

#include <fmt/format.h>

#include <utility>
#include <vector>

#include "common/base/log.h"
#include "common/options/option_problems.h"
#include "edge/daemon/camera_access.h"
#include "edge/daemon/count_losses.h"
#include "edge/daemon/make_camera.h"
#include "edge/options/edge_options.pb.h"
#include "edge/source/camera_pair.h"
#include "edge/source/replay_source.h"
#include "edge/source/supervised_source.h"
#include "edge/source/synthetic_source.h"
#include "edge/thermal_camera/camera_registry.h"

namespace isotherm {
namespace {

std::unique_ptr<SupervisedSource> Supervise(std::unique_ptr<FrameSource> source,
                                            const EdgeOptions& options,
                                            const SourceContext& context) {
  const auto count_as = [&counters = context.counters](FrameFate fate) {
    return [fate, &counters](Sensor sensor) { counters.Count(sensor, fate); };
  };
  auto supervised = std::make_unique<SupervisedSource>(
      std::move(source), options.frame_check(), context.clock, count_as(FrameFate::kCaptured),
      count_as(FrameFate::kRejected));
  // A camera of another size or serial number must not be used with this calibration.
  if (context.calibration) supervised->Expect(*context.calibration);
  return supervised;
}

void Report(Sensor sensor, const std::string& problem, ToldProblems& told) {
  // The source is made again and again until a camera can be used; each problem is told once.
  if (std::exchange(told[sensor], problem) == problem) return;
  LOG(Edge, Warning) << problem;
}

Result<std::unique_ptr<FrameSource>> MakeCameras(const EdgeOptions& options,
                                                 const SourceContext& context, ToldProblems& told) {
  const SourceOptions& source = options.source();
  std::vector<CameraPair::Camera> cameras;
  for (const Sensor sensor : {Sensor::kDepth, Sensor::kThermal}) {
    const bool enabled = sensor == Sensor::kDepth ? source.depth_camera().enabled()
                                                  : source.thermal_camera().enabled();
    if (!enabled) continue;
    Result<std::unique_ptr<FrameSource>> camera =
        RunsInOwnProcess(sensor, source)
            ? MakeCameraProcess(sensor, source, context.clock, context.stop)
            : MakeCamera(sensor, source, context.clock);
    if (!camera) {
      Report(sensor, camera.error().message(), told);
      continue;
    }
    auto supervised = Supervise(std::move(*camera), options, context);
    supervised->OnWorks(
        [&health = context.health, sensor](bool works) { health.SetWorks(sensor, works); });
    supervised->OnOpened(
        [&health = context.health](const CameraDescription& opened) { health.SetOpened(opened); });
    CountLosses(*supervised, context.counters);
    cameras.push_back({sensor, std::move(supervised)});
  }
  if (cameras.empty()) return Err(Unavailable("no camera can be used"));
  CameraPair::Queue queue;
  queue.capacity = static_cast<std::size_t>(options.source().expert().capture_queue_frames());
  queue.policy = source.rate() > 0.0 ? OverflowPolicy::kDropOldest : OverflowPolicy::kBlock;
  // A frame that is dropped here reaches neither the recording nor the link: it counts for both.
  queue.on_drop = [&counters = context.counters](Sensor sensor) {
    counters.Count(sensor, FrameFate::kRecordQueueFull);
    counters.Count(sensor, FrameFate::kPublishQueueFull);
  };
  return std::make_unique<CameraPair>(std::move(cameras), std::move(queue));
}

}  // namespace

Status Validate(const SourceOptions& options) {
  OptionProblems problems("source");
  problems.CheckRange("rate", options.rate(), 0.0, 100.0);
  problems.CheckRange("loops", options.loops(), 0, 1'000'000);
  problems.CheckRange("rig_max_age_days", options.rig_max_age_days(), 0, 100'000);
  problems.CheckRange("expert.capture_queue_frames", options.expert().capture_queue_frames(), 1,
                      1000);
  if (options.kind() == REPLAY && options.recording().empty()) {
    problems.Add("recording", "is empty; name the file to replay (--recording FILE)");
  }
  if (options.kind() == CAMERAS) {
    problems.Add(Validate(options.depth_camera()));
    // OpenNI2 plays a file at any rate; beside a real camera it must keep to real time.
    const bool is_file =
        options.depth_camera().uri().ends_with(".oni") && !options.thermal_camera().enabled();
    if (options.rate() != 1.0 && !is_file) {
      problems.Add("rate", fmt::format("is {}, but cameras have a pace of their own: leave it at 1",
                                       options.rate()));
    }
    if (!options.depth_camera().enabled() && !options.thermal_camera().enabled()) {
      problems.Add("depth_camera.enabled",
                   "is false, and thermal_camera.enabled too: no camera is left");
    }
  }
  problems.Add(Validate(options.thermal_camera()));
  problems.Add(Validate(options.camera_sandbox()));
  return problems.ToStatus();
}

Result<std::unique_ptr<FrameSource>> MakeSource(const EdgeOptions& options,
                                                const SourceContext& context, ToldProblems& told) {
  const SourceOptions& source = options.source();
  switch (source.kind()) {
    case REPLAY:
      return Supervise(std::make_unique<ReplaySource>(source, source.recording(), context.clock),
                       options, context);
    case CAMERAS:
      return MakeCameras(options, context, told);
    case SYNTHETIC:
      break;
  }
  return Supervise(std::make_unique<SyntheticSource>(source, context.clock, context.stop), options,
                   context);
}

}  // namespace isotherm
