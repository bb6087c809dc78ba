#include "tests/benchmark/frames.h"

#include "common/base/check.h"
#include "common/simulation/simulated_scan.h"
#include "common/simulation/simulation_options.pb.h"

namespace isotherm {
namespace {

constexpr std::size_t kDepthFrames = 24;
constexpr std::size_t kThermalFrames = 32;

BenchmarkFrames Render() {
  const Result<std::unique_ptr<SimulatedScan>> scan = SimulatedScan::Create(SimulationOptions());
  CHECK(scan.has_value());
  SimulatedScan::Scratch scratch;
  BenchmarkFrames frames;
  frames.rig = (*scan)->rig();
  for (std::size_t i = 0; i < kDepthFrames; ++i) {
    RawFrame raw = (*scan)->RenderDepth(i, scratch);
    DepthFrame& frame = frames.depth.emplace_back();
    frame.header.frame_number = i;
    frame.header.capture_time = (*scan)->depth_times()[i].exposure;
    frame.depth_raw = std::move(raw.pixels);
    frame.depth_scale = raw.depth_scale;
  }
  for (std::size_t i = 0; i < kThermalFrames; ++i) {
    RawFrame raw = (*scan)->RenderThermal(i, scratch);
    ThermalFrame& frame = frames.thermal.emplace_back();
    frame.header.frame_number = i;
    frame.header.capture_time = (*scan)->thermal_times()[i].exposure;
    frame.centikelvin = std::move(raw.pixels);
    frame.valid = true;
  }
  return frames;
}

}  // namespace

const BenchmarkFrames& FurnaceDoorFrames() {
  static const BenchmarkFrames frames = Render();
  return frames;
}

}  // namespace isotherm
