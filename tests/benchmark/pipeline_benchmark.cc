#include <benchmark/benchmark.h>

#include <memory>
#include <string>

#include "common/base/check.h"
#include "ground/pipeline/ground_pipeline.h"
#include "tests/benchmark/frames.h"

namespace isotherm {
namespace {

/// One iteration is the beginning of a scan through all stages, depth and thermal, with a new
/// volume.
void Pipeline(benchmark::State& state) {
  const BenchmarkFrames& frames = FurnaceDoorFrames();
  std::vector<ThermalFramePtr> thermal;
  for (const ThermalFrame& frame : frames.thermal)
    thermal.push_back(std::make_shared<ThermalFrame>(frame));
  GroundOptions options;
  options.mutable_volume()->set_voxel_size_m(1e-3 * static_cast<double>(state.range(0)));
  options.set_threads(static_cast<int>(state.range(1)));

  std::unique_ptr<GroundPipeline> last;  // Its times are told.
  while (state.KeepRunning()) {
    Result<std::unique_ptr<GroundPipeline>> pipeline =
        GroundPipeline::Create(options, frames.rig, std::nullopt);
    CHECK(pipeline.has_value());
    std::size_t next_thermal = 0;
    for (const DepthFrame& depth : frames.depth) {
      while (next_thermal < thermal.size() &&
             thermal[next_thermal]->header.capture_time <= depth.header.capture_time) {
        (*pipeline)->ProcessThermal(thermal[next_thermal++]);
      }
      (*pipeline)->ProcessDepth(depth);
    }
    (*pipeline)->Finish();
    state.counters["tracked"] = static_cast<double>((*pipeline)->model().counts.depth_tracked);
    last = std::move(*pipeline);
  }
  state.counters["frames/s"] = benchmark::Counter(
      static_cast<double>(state.iterations()) * static_cast<double>(frames.depth.size()),
      benchmark::Counter::kIsRate);
  for (const Stage stage : AllValues<Stage>()) {
    const StageStats* stats = last->model().stages[stage];
    if (stats == nullptr) continue;
    const std::string name(ToString(stage));
    state.counters[name + "_p50_ms"] = stats->Percentile(50);
    state.counters[name + "_p95_ms"] = stats->Percentile(95);
    state.counters[name + "_p99_ms"] = stats->Percentile(99);
  }
}

BENCHMARK(Pipeline)
    ->Name("BM_Pipeline")
    ->ArgNames({"voxel_mm", "threads"})
    ->Args({2, 1})
    ->Args({2, 2})
    ->Args({4, 2})
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();

}  // namespace
}  // namespace isotherm
