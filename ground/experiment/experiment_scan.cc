#include "ground/experiment/experiment_scan.h"

#include <fmt/format.h>

#include <algorithm>
#include <numbers>
#include <tuple>
#include <utility>

namespace isotherm {
namespace {

struct ScheduledFrame {
  CaptureTime time;
  Sensor sensor;
  std::uint64_t number;
};

std::vector<ScheduledFrame> InOrderOfTime(const SimulatedScan& scan) {
  std::vector<ScheduledFrame> items;
  const auto add = [&](Sensor sensor, const std::vector<SimulatedFrameTime>& times) {
    for (std::size_t i = 0; i < times.size(); ++i) items.push_back({times[i].exposure, sensor, i});
  };
  add(Sensor::kDepth, scan.depth_times());
  add(Sensor::kThermal, scan.thermal_times());
  std::ranges::sort(items, {}, [](const ScheduledFrame& item) {
    return std::tuple(item.time, item.sensor, item.number);
  });
  return items;
}

DepthFrame ToDepthFrame(RawFrame raw, CaptureTime time) {
  DepthFrame frame;
  frame.header.frame_number = raw.frame_number;
  frame.header.capture_time = time;
  frame.depth_scale = raw.depth_scale;
  frame.depth_raw = std::move(raw.pixels);
  return frame;
}

ThermalFramePtr ToThermalFrame(RawFrame raw, CaptureTime time, const SimulatedScan& scan) {
  auto frame = std::make_shared<ThermalFrame>();
  frame->header.frame_number = raw.frame_number;
  frame->header.capture_time = time;
  frame->nuc_state = raw.shutter_closed ? NucState::kInProgress : NucState::kIdle;
  frame->nuc_source = NucSource::kInBand;
  if (const auto opening = scan.LastOpening(time))
    frame->seconds_since_nuc = ToSeconds(time - *opening);
  frame->housekeeping = raw.housekeeping;
  frame->valid = !raw.shutter_closed;
  frame->temperature_raw = std::move(raw.pixels);
  frame->scale = raw.thermal_scale;
  return frame;
}

}  // namespace

SimulationOptions ExperimentCameras(double duration_s, double focus_m) {
  constexpr double kThermal_hz = 20.0;
  SimulationOptions options;
  options.set_duration_s(duration_s);
  options.set_ideal_cameras(false);
  options.mutable_thermal()->set_rate_hz(kThermal_hz);
  options.mutable_thermal()->mutable_expert()->mutable_lens()->set_focus_m(focus_m);
  // No corrections, unless the experiment is about them.
  options.mutable_shutter()->set_interval_s(0.0);
  return options;
}

GroundOptions OptionsForSlantedSurfaces() {
  GroundOptions options;
  ThermalAngleOptions& angle = *options.mutable_thermal()->mutable_angle();
  angle.set_min_deg(0.0);
  angle.set_good_deg(40.0);
  angle.set_max_deg(60.0);
  return options;
}

Swing FromTo(double from, double to, double duration_s) {
  return {(from + to) / 2.0, (to - from) / 2.0, 2.0 * duration_s, -std::numbers::pi / 2.0};
}

void PlayScan(const SimulatedScan& scan, ThreadPool& pool, const FrameSinks& sinks) {
  // Threads wait for the slowest frame of a batch. More: less waiting and more memory. Not tuned.
  constexpr int kFramesPerThread = 4;
  const std::vector<ScheduledFrame> items = InOrderOfTime(scan);
  // Frames of a batch are rendered in parallel and passed on one after the other.
  const auto batch = static_cast<std::size_t>(pool.threads() * kFramesPerThread);
  std::vector<SimulatedScan::Scratch> scratch(batch);
  std::vector<RawFrame> frames(batch);
  for (std::size_t done = 0; done < items.size(); done += batch) {
    const std::size_t count = std::min(batch, items.size() - done);
    pool.ParallelFor(static_cast<int>(count), [&](int i) {
      const auto index = static_cast<std::size_t>(i);
      const ScheduledFrame& item = items[done + index];
      frames[index] = item.sensor == Sensor::kDepth
                          ? scan.RenderDepth(item.number, scratch[index])
                          : scan.RenderThermal(item.number, scratch[index]);
    });
    for (std::size_t i = 0; i < count; ++i) {
      const ScheduledFrame& item = items[done + i];
      if (item.sensor == Sensor::kDepth) {
        sinks.depth(ToDepthFrame(std::move(frames[i]), item.time));
      } else {
        sinks.thermal(ToThermalFrame(std::move(frames[i]), item.time, scan));
      }
    }
  }
}

Result<std::unique_ptr<GroundPipeline>> StartPipeline(GroundOptions options,
                                                      const SimulatedScan& scan,
                                                      const ThreadPool& pool) {
  options.set_threads(pool.threads());
  return GroundPipeline::Create(options, scan.rig(), scan.PoseAt(scan.depth_times()[0].exposure));
}

Status CheckTracked(const ScanModel& model) {
  const ScanCounts& counts = model.counts;
  if (counts.depth_tracked == counts.depth_in) return OkStatus();
  return FailedPrecondition(
      fmt::format("the rig was tracked in {} of {} depth frames only: the experiment says nothing",
                  counts.depth_tracked, counts.depth_in));
}

Result<PlayedScan> Play(const SimulationOptions& cameras, StagedScene staged,
                        const std::vector<GroundOptions>& options, ThreadPool& pool) {
  PlayedScan played;
  Result<std::unique_ptr<SimulatedScan>> scan = SimulatedScan::Create(cameras, std::move(staged));
  if (!scan) return Err(scan.error());
  played.scan = std::move(*scan);
  for (const GroundOptions& each : options) {
    auto pipeline = StartPipeline(each, *played.scan, pool);
    if (!pipeline) return Err(pipeline.error());
    played.pipelines.push_back(std::move(*pipeline));
  }
  PlayScan(*played.scan, pool,
           {[&](const DepthFrame& frame) {
              for (const auto& pipeline : played.pipelines) pipeline->ProcessDepth(frame);
            },
            [&](const ThermalFramePtr& frame) {
              for (const auto& pipeline : played.pipelines) pipeline->ProcessThermal(frame);
            }});
  for (const auto& pipeline : played.pipelines) {
    pipeline->Finish();
    if (Status status = CheckTracked(pipeline->model()); !status.ok()) return Err(status);
  }
  return played;
}

}  // namespace isotherm
