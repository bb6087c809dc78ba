// What does a frame cost, against each thing that it may grow with? Both cameras slide to and fro
// before a wall with a ball, a post and a ledge in every quarter of a metre, without noise: the
// images are always the same, and what is in view is known.
#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <memory>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "common/base/check.h"
#include "ground/pipeline/ground_pipeline.h"
#include "ground/surface/testing/analytic_views.h"
#include "tests/benchmark/machine.h"

namespace isotherm {
namespace {

constexpr double kDepth_hz = 30.0;
constexpr double kSpeed_m_s = 0.15;
constexpr int kDepthSteps = 24;  // From one end of the way to the other.
constexpr int kThermalSteps = 32;
constexpr int kCycles = 3;  // To and fro: the first one makes the model.
constexpr double kWall_m = 0.75;

/// Holds what differs from one measurement to the next.
struct Setup {
  double distance_m = 0.6;  // From the depth camera to the wall.
  double volume_m = 1.92;   // Edges of the cube.
  double voxel_m = 0.002;
  int width = 640;
  int height = 480;
  int minutes = 0;  // 0: kCycles.
};

double Wall(const Eigen::Vector3d& p) {
  constexpr double kPeriod = 0.24;
  const double x = p.x() - kPeriod * std::round(p.x() / kPeriod);
  const double y = p.y() - kPeriod * std::round(p.y() / kPeriod);
  const double ball = Eigen::Vector3d(x - 0.03, y - 0.05, p.z() - 0.74).norm() - 0.05;
  const double post = std::hypot(x + 0.08, p.z() - 0.73) - 0.025;
  const double ledge = std::hypot(y + 0.08, p.z() - 0.74) - 0.03;
  return std::min({kWall_m - p.z(), ball, post, ledge});
}

/// Sees 58.6 degrees across, as PrimeSense's cameras do, whatever the size of the image.
CameraModel DepthCamera(const Setup& setup) {
  CameraModel camera;
  camera.width = setup.width;
  camera.height = setup.height;
  camera.fx = camera.fy = 570.0 / 640.0 * setup.width;
  camera.cx = (setup.width - 1) / 2.0;
  camera.cy = (setup.height - 1) / 2.0;
  return camera;
}

CameraModel ThermalCamera() {
  CameraModel camera;
  camera.width = 382;
  camera.height = 288;
  camera.fx = camera.fy = 550.0;
  camera.cx = 190.5;
  camera.cy = 143.5;
  return camera;
}

RigidTransform PoseAt(const Setup& setup, double way_m) {
  return MakeTransform({way_m, 0.0, kWall_m - setup.distance_m}, Eigen::Quaterniond::Identity());
}

/// The frames of the way there; those of the way back are the same.
struct Frames {
  std::vector<DepthFrame> depth;
  std::vector<ThermalFrame> thermal;
};

ThermalFrame RenderThermal(const RigidTransform& T_world_thermal) {
  const CameraModel camera = ThermalCamera();
  const DepthFrame seen = testing::RenderDepth(Wall, camera, T_world_thermal);
  ThermalFrame frame;
  frame.temperature_raw = Image<std::uint16_t>(camera.width, camera.height);
  for (int v = 0; v < camera.height; ++v) {
    for (int u = 0; u < camera.width; ++u) {
      const double z = seen.depth_raw.At(u, v) / seen.depth_scale;
      const Eigen::Vector3d point =
          T_world_thermal *
          Eigen::Vector3d((u - camera.cx) / camera.fx * z, (v - camera.cy) / camera.fy * z, z);
      const double kelvin = 310.0 + 8.0 * std::sin(25.0 * point.x()) * std::cos(25.0 * point.y());
      frame.temperature_raw.At(u, v) = static_cast<std::uint16_t>(std::lround(100.0 * kelvin));
    }
  }
  frame.nuc_state = NucState::kIdle;
  frame.valid = true;
  return frame;
}

Rig RigOf(const Setup& setup) {
  Rig rig;
  rig.depth = DepthCamera(setup);
  rig.thermal = ThermalCamera();
  rig.T_thermal_depth = MakeTransform({-0.05, 0.0, 0.0}, Eigen::Quaterniond::Identity());
  return rig;
}

/// Renders them once for each distance and size of the image.
const Frames& FramesOf(const Setup& setup) {
  static std::vector<std::pair<Setup, Frames>> all;
  for (const auto& [known, frames] : all) {
    if (known.distance_m == setup.distance_m && known.width == setup.width &&
        known.height == setup.height)
      return frames;
  }
  Frames frames;
  const Rig rig = RigOf(setup);
  const double length_m = kSpeed_m_s * kDepthSteps / kDepth_hz;
  for (int i = 0; i <= kDepthSteps; ++i) {
    frames.depth.push_back(
        testing::RenderDepth(Wall, *rig.depth, PoseAt(setup, length_m * i / kDepthSteps)));
  }
  for (int i = 0; i <= kThermalSteps; ++i) {
    const RigidTransform pose = PoseAt(setup, length_m * i / kThermalSteps);
    frames.thermal.push_back(RenderThermal(pose * rig.T_thermal_depth->inverse()));
  }
  return all.emplace_back(setup, std::move(frames)).second;
}

/// 0 1 2 ... steps ... 2 1 0 1 ...
std::size_t ToAndFro(int i, int steps) {
  const int in_cycle = i % (2 * steps);
  return static_cast<std::size_t>(std::min(in_cycle, 2 * steps - in_cycle));
}

GroundOptions OptionsOf(const Setup& setup) {
  GroundOptions options;
  VolumeOptions& volume = *options.mutable_volume();
  volume.set_voxel_size_m(setup.voxel_m);
  volume.set_size_x_m(setup.volume_m);
  volume.set_size_y_m(setup.volume_m);
  volume.set_size_z_m(setup.volume_m);
  volume.mutable_expert()->set_min_x_m(-setup.volume_m / 2.0);
  volume.mutable_expert()->set_min_y_m(-setup.volume_m / 2.0);
  volume.mutable_expert()->set_min_z_m(kWall_m - setup.volume_m / 2.0);
  options.set_threads(2);
  return options;
}

/// Runs one cycle. Returns how long it took.
double RunCycle(GroundPipeline& pipeline, const Frames& frames, int cycle) {
  const auto start = std::chrono::steady_clock::now();
  for (int i = 0, j = 0; i < 2 * kDepthSteps; ++i) {
    const int number = cycle * 2 * kDepthSteps + i;
    const double time_s = number / kDepth_hz;
    for (; j * kDepthSteps <= i * kThermalSteps; ++j) {
      ThermalFrame thermal = frames.thermal[ToAndFro(j, kThermalSteps)];
      thermal.header.frame_number = static_cast<std::uint64_t>(cycle * 2 * kThermalSteps + j);
      thermal.header.capture_time = CaptureTime(
          FromSeconds((cycle * 2 * kThermalSteps + j) / (kDepth_hz * kThermalSteps / kDepthSteps)));
      pipeline.ProcessThermal(std::make_shared<ThermalFrame>(std::move(thermal)));
    }
    DepthFrame depth = frames.depth[ToAndFro(i, kDepthSteps)];
    depth.header.frame_number = static_cast<std::uint64_t>(number);
    depth.header.capture_time = CaptureTime(FromSeconds(time_s));
    pipeline.ProcessDepth(depth);
  }
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

void Measure(benchmark::State& state, const Setup& setup) {
  const Frames& frames = FramesOf(setup);
  constexpr double kCycle_s = 2 * kDepthSteps / kDepth_hz;
  constexpr double kMinute_s = 60.0;
  const int cycles = setup.minutes > 0
                         ? static_cast<int>(std::lround(setup.minutes * kMinute_s / kCycle_s))
                         : kCycles;
  while (state.KeepRunning()) {
    const auto pipeline =
        GroundPipeline::Create(OptionsOf(setup), RigOf(setup), PoseAt(setup, 0.0));
    CHECK(pipeline.has_value());
    std::vector<std::pair<double, int>> of_minute;  // Seconds, and cycles.
    double busy_s = 0.0;
    for (int cycle = 0; cycle < cycles; ++cycle) {
      const double took_s = RunCycle(**pipeline, frames, cycle);
      if (cycle > 0) busy_s += took_s;
      const auto minute = static_cast<std::size_t>(cycle * kCycle_s / kMinute_s);
      if (minute >= of_minute.size()) of_minute.emplace_back();
      of_minute[minute].first += took_s;
      ++of_minute[minute].second;
    }
    const ScanModel model = (*pipeline)->model();
    if (model.counts.depth_tracked != static_cast<std::uint64_t>(cycles * 2 * kDepthSteps)) {
      state.SkipWithError("not all frames were tracked");
      return;
    }
    state.counters["depth_ms"] = model.stages[Stage::kDepthFrame]->Percentile(50);
    state.counters["thermal_ms"] = model.stages[Stage::kThermalFrame]->Percentile(50);
    // Of one second of both cameras' frames.
    state.counters["second_ms"] = 1e3 * busy_s / ((cycles - 1) * kCycle_s);
    state.counters["resident_mib"] = ResidentMib();
    state.counters["blocks"] = model.tsdf().block_count();
    const double across_m = 640.0 / 570.0 * setup.distance_m;
    state.counters["view_m2"] = across_m * across_m * setup.height / setup.width;
    if (setup.minutes == 0) continue;
    for (std::size_t i = 0; i < of_minute.size(); ++i) {
      state.counters[fmt::format("minute_{:02}", i + 1)] =
          1e3 * of_minute[i].first / (of_minute[i].second * kCycle_s);
    }
  }
}

void Register(const std::string& name, const Setup& setup) {
  benchmark::RegisterBenchmark(name.c_str(), &Measure, setup)
      ->Iterations(1)
      ->Repetitions(setup.minutes > 0 ? 1 : 3)
      ->ReportAggregatesOnly(setup.minutes == 0)
      ->Unit(benchmark::kSecond)
      ->UseRealTime();
}

void RegisterAll() {
  for (const double distance_m : {0.45, 0.6, 0.75, 0.9, 1.05})
    Register(fmt::format("distance_m:{}", distance_m), {.distance_m = distance_m});
  for (const double volume_m : {0.96, 1.92, 3.84, 7.68})
    Register(fmt::format("volume_m:{}", volume_m), {.volume_m = volume_m});
  for (const double voxel_m : {0.001, 0.0015, 0.002, 0.003, 0.004})
    Register(fmt::format("voxel_mm:{}", 1e3 * voxel_m), {.voxel_m = voxel_m});
  const std::pair<int, int> kSizes[] = {
      {320, 240}, {480, 360}, {640, 480}, {960, 720}, {1280, 720}};
  for (const auto& [width, height] : kSizes)
    Register(fmt::format("pixels:{}", width * height), {.width = width, .height = height});
  Register("minutes:10", {.minutes = 10});
}

}  // namespace
}  // namespace isotherm

int main(int argc, char** argv) {
  isotherm::RegisterAll();
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 1;
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}
