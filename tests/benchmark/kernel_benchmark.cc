// Time per pixel, voxel or ray of the stages' inner loops, through their public classes, against a
// model of the simulated furnace door that has seen all frames. One and two threads; the best SIMD
// instruction set of this processor and the common one (AVX2, NEON).
#include <benchmark/benchmark.h>
#include <hwy/highway.h>

#include <cmath>
#include <functional>
#include <memory>
#include <string>

#include "common/base/check.h"
#include "common/base/units.h"
#include "common/geometry/map_pose.h"
#include "ground/icp/icp_tracker.h"
#include "ground/options/ground_options.pb.h"
#include "ground/surface/depth_preprocessor.h"
#include "ground/thermal/thermal_fuser.h"
#include "ground/tsdf/raycaster.h"
#include "ground/tsdf/tsdf_integrator.h"
#include "tests/benchmark/frames.h"
#include "tests/benchmark/machine.h"

namespace isotherm {
namespace {

constexpr std::int32_t kMaxBlocks = 1 << 16;

/// A model made of all simulated frames at their true poses, and what the stages need to go on with
/// the last one.
class Scene {
 public:
  Scene() : preprocessor_(options.preprocessor(), *frames.rig.depth, frames.rig.depth_sensor) {
    const Result<VoxelGrid> grid = MakeVoxelGrid(options.volume());
    CHECK(grid.has_value() && frames.rig.thermal && frames.rig.T_thermal_depth);
    volume = std::make_unique<TsdfVolume>(
        *grid, TruncationDistance(options.tsdf(), options.volume()), kMaxBlocks);
    ThreadPool pool(1);
    TsdfIntegrator integrator(options.tsdf());
    for (std::size_t i = 0; i < frames.depth.size(); ++i)
      integrator.Integrate(preprocessor_.Process(frames.depth[i], pool),
                           InFirstMap(frames.truth[i].T_world_depth), pool, *volume);
    last = &preprocessor_.Process(frames.depth.back(), pool);
    T_map_depth = InFirstMap(frames.truth.back().T_world_depth);
    const RigidTransform& before = InFirstMap(frames.truth[frames.truth.size() - 2].T_world_depth);
    view = {{}, last->camera.Downscaled(options.raycast().expert().halvings()), before};
    Raycaster().Cast(*volume, view.camera, before, MinWeight(), pool, view.maps);
  }

  float MinWeight() const { return static_cast<float>(options.raycast().expert().min_weight()); }

  const BenchmarkFrames& frames = FurnaceDoorFrames();
  const GroundOptions options;
  std::unique_ptr<TsdfVolume> volume;
  const PreparedDepth* last = nullptr;
  RigidTransform T_map_depth;  ///< Pose of the last frame.
  ModelView view;              ///< From the pose before.

 private:
  DepthPreprocessor preprocessor_;
};

Scene& SharedScene() {
  static Scene scene;
  return scene;
}

/// Seconds per item, as Google Benchmark shows them: "1.5ns".
benchmark::Counter PerItem(std::size_t items) {
  return {static_cast<double>(items),
          benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert};
}

void Preprocess(benchmark::State& state, ThreadPool& pool) {
  const Scene& scene = SharedScene();
  DepthPreprocessor preprocessor(scene.options.preprocessor(), *scene.frames.rig.depth,
                                 scene.frames.rig.depth_sensor);
  while (state.KeepRunning())
    benchmark::DoNotOptimize(preprocessor.Process(scene.frames.depth.back(), pool).valid_pixels);
  state.counters["per_pixel"] = PerItem(scene.last->depth_m.size());
}

void Bilateral(benchmark::State& state, ThreadPool& pool) {
  const Scene& scene = SharedScene();
  Image<float> filtered_m;
  while (state.KeepRunning()) {
    BilateralFilter(scene.last->depth_m, scene.options.preprocessor().expert(),
                    scene.frames.rig.depth_sensor.noise_at_1m_m, pool, filtered_m);
    benchmark::DoNotOptimize(filtered_m.data());
  }
  state.counters["per_pixel"] = PerItem(filtered_m.size());
}

void MakeMaps(benchmark::State& state, ThreadPool& pool) {
  const Scene& scene = SharedScene();
  const PreprocessorOptions& options = scene.options.preprocessor();
  constexpr int kReach = 3;
  SurfaceMaps maps;
  while (state.KeepRunning()) {
    MakeSurfaceMaps(
        scene.last->depth_m, scene.last->camera,
        {kReach, StepPerPixel(scene.last->camera, options.expert().max_surface_angle_deg()),
         scene.last->noise_at_1m},
        pool, maps);
    benchmark::DoNotOptimize(maps.nz.data());
  }
  state.counters["per_pixel"] = PerItem(maps.vx.size());
}

void Icp(benchmark::State& state, ThreadPool& pool, std::size_t level) {
  const Scene& scene = SharedScene();
  const TrackerOptions& options = scene.options.tracker();
  const IcpLimits limits{
      static_cast<float>(options.expert().max_distance_m()),
      static_cast<float>(std::cos(options.expert().max_normal_angle_deg() * kRadPerDeg))};
  const SurfaceMaps& maps = scene.last->maps[level];
  while (state.KeepRunning()) {
    benchmark::DoNotOptimize(
        AccumulateIcp(maps, scene.T_map_depth, scene.view, scene.volume->grid(), limits, pool));
  }
  state.counters["per_pixel"] = PerItem(maps.vx.size());
}

void Integrate(benchmark::State& state, ThreadPool& pool) {
  Scene& scene = SharedScene();
  TsdfIntegrator integrator(scene.options.tsdf());
  while (state.KeepRunning())
    integrator.Integrate(*scene.last, scene.T_map_depth, pool, *scene.volume);
  state.counters["per_voxel"] = PerItem(integrator.updated_blocks().size() * kBlockVoxels);
}

void Raycast(benchmark::State& state, ThreadPool& pool, int halvings) {
  const Scene& scene = SharedScene();
  const CameraModel camera = scene.last->camera.Downscaled(halvings);
  Raycaster raycaster;
  SurfaceMaps maps;
  while (state.KeepRunning()) {
    raycaster.Cast(*scene.volume, camera, scene.T_map_depth, scene.MinWeight(), pool, maps);
    benchmark::DoNotOptimize(maps.vz.data());
  }
  state.counters["per_ray"] = PerItem(maps.vx.size());
}

void FuseThermal(benchmark::State& state, ThreadPool& pool) {
  const Scene& scene = SharedScene();
  const Rig& rig = scene.frames.rig;
  const RigidTransform T_map_thermal = scene.view.T_map_depth * rig.T_thermal_depth->inverse();
  const ThermalFrame& frame = scene.frames.thermal.back();
  ThermalFuser fuser(scene.options.thermal(), *rig.thermal, rig.thermal_sensor, scene.MinWeight());
  ThermalVolume thermal(kMaxBlocks);
  FusionReport report;
  while (state.KeepRunning()) {
    report = fuser.Fuse({frame, T_map_thermal, scene.view.camera, scene.view.T_map_depth}, {},
                        *scene.volume, pool, thermal);
  }
  CHECK(report.assigned > 0);
  state.counters["per_pixel"] = PerItem(frame.temperature_raw.size());
}

using Kernel = std::function<void(benchmark::State&, ThreadPool&)>;

/// Runs `kernel` with the instruction set `target` or, where it has none for that, the next lower.
void Register(const std::string& name, const Kernel& kernel, std::int64_t target) {
  const auto run = [kernel, target](benchmark::State& state) {
    hwy::SetSupportedTargetsForTest(0);
    const std::int64_t better = target - 1;
    hwy::SetSupportedTargetsForTest(hwy::SupportedTargets() & ~better);
    ThreadPool pool(static_cast<int>(state.range(0)));
    kernel(state, pool);
    hwy::SetSupportedTargetsForTest(0);
  };
  constexpr int kRepetitions = 5;
  benchmark::RegisterBenchmark((name + "/simd:" + hwy::TargetName(target)).c_str(), run)
      ->ArgName("threads")
      ->Arg(1)
      ->Arg(2)
      ->UseRealTime()
      ->Unit(benchmark::kMillisecond)
      ->MinTime(0.05)
      ->Repetitions(kRepetitions)
      ->ReportAggregatesOnly();
}

void RegisterAll(std::int64_t target) {
  using std::placeholders::_1;
  using std::placeholders::_2;
  Register("BM_Preprocess", Preprocess, target);
  Register("BM_BilateralFilter", Bilateral, target);
  Register("BM_SurfaceMaps", MakeMaps, target);
  for (int level = 0; level < kPyramidLevels; ++level)
    Register("BM_Icp/level:" + std::to_string(level), std::bind(Icp, _1, _2, level), target);
  Register("BM_TsdfIntegrate", Integrate, target);
  for (const int halvings : {0, 1})
    Register("BM_Raycast/halvings:" + std::to_string(halvings),
             std::bind(Raycast, _1, _2, halvings), target);
  Register("BM_ThermalFuse", FuseThermal, target);
}

void RegisterTargets() {
#if HWY_ARCH_X86
  constexpr std::int64_t kCommon = HWY_AVX2;
#else
  constexpr std::int64_t kCommon = HWY_NEON;
#endif
  const std::int64_t supported = hwy::SupportedTargets() & HWY_TARGETS;
  const std::int64_t best = supported & -supported;
  RegisterAll(best);
  if (best != kCommon && (supported & kCommon) != 0) RegisterAll(kCommon);
}

}  // namespace
}  // namespace isotherm

int main(int argc, char** argv) {
  benchmark::AddCustomContext("machine", isotherm::DescribeMachine());
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 64;
  isotherm::RegisterTargets();
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}
