// Does a frame cost more the longer the scan and the larger the volume? A camera slides along a
// wall that repeats itself, so that every period of the way shows exactly the same images:
// whatever grows is the model's fault.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "common/base/check.h"
#include "common/base/quantile.h"
#include "ground/pipeline/ground_pipeline.h"
#include "ground/surface/testing/analytic_views.h"
#include "tests/benchmark/machine.h"

namespace isotherm {
namespace {

constexpr double kPeriod = 0.24;  // Metres along x after which the wall repeats itself.
constexpr int kFramesPerPeriod = 48;
constexpr double kStep = kPeriod / kFramesPerPeriod;

CameraModel Camera() {
  CameraModel camera;
  camera.width = 640;
  camera.height = 480;
  camera.fx = camera.fy = 570.0;
  camera.cx = 319.5;
  camera.cy = 239.5;
  return camera;
}

/// A wall at z = 0.75 m with a ball and a post in every period.
double Wall(const Eigen::Vector3d& p) {
  const double x = p.x() - kPeriod * std::round(p.x() / kPeriod);
  const double ball = Eigen::Vector3d(x - 0.03, p.y() - 0.05, p.z() - 0.74).norm() - 0.06;
  const double post = std::hypot(x + 0.08, p.z() - 0.73) - 0.025;
  const double ledge = std::hypot(p.y() + 0.12, p.z() - 0.74) - 0.03;
  return std::min({0.75 - p.z(), ball, post, ledge});
}

/// One period's frames, which serve for all periods.
const std::vector<DepthFrame>& PeriodFrames() {
  static const std::vector<DepthFrame> frames = [] {
    std::vector<DepthFrame> rendered;
    for (int i = 0; i < kFramesPerPeriod; ++i) {
      rendered.push_back(testing::RenderDepth(
          Wall, Camera(), MakeTransform({i * kStep, 0.0, 0.0}, Eigen::Quaterniond::Identity())));
    }
    return rendered;
  }();
  return frames;
}

/// The same for equal voxels. Touches them all.
double VoxelSum(const TsdfVolume& volume) {
  double sum = 0.0;
  for (std::int32_t block = 0; block < volume.block_count(); ++block) {
    for (const TsdfVoxel voxel : volume.voxels(block)) sum += voxel.bits % 65521;
  }
  return sum;
}

void Growth(benchmark::State& state) {
  const int periods = static_cast<int>(state.range(0));
  GroundOptions options;
  VolumeOptions& volume = *options.mutable_volume();
  volume.set_size_x_m(1e-2 * static_cast<double>(state.range(1)));
  volume.mutable_expert()->set_min_x_m(-0.48);
  volume.mutable_expert()->set_min_y_m(-0.48);
  volume.mutable_expert()->set_min_z_m(0.24);
  if (state.range(2) > 0) {
    volume.mutable_expert()->set_max_memory_bytes(static_cast<std::uint64_t>(state.range(2)) << 20);
    volume.set_spill_dir(std::filesystem::temp_directory_path().string());
  }
  options.set_threads(2);
  Rig rig;
  rig.depth = Camera();
  while (state.KeepRunning()) {
    const auto pipeline = GroundPipeline::Create(options, rig, RigidTransform::Identity());
    CHECK(pipeline.has_value());
    std::vector<double> last_period_ms;
    const int frames = periods * kFramesPerPeriod;
    for (int i = 0; i < frames; ++i) {
      DepthFrame frame = PeriodFrames()[static_cast<std::size_t>(i % kFramesPerPeriod)];
      frame.header.frame_number = static_cast<std::uint64_t>(i);
      frame.header.capture_time = CaptureTime(FromSeconds(i / 30.0));
      const auto start = std::chrono::steady_clock::now();
      (*pipeline)->ProcessDepth(frame);
      const std::chrono::duration<double, std::milli> elapsed =
          std::chrono::steady_clock::now() - start;
      if (i >= frames - kFramesPerPeriod) last_period_ms.push_back(elapsed.count());
    }
    const RigidTransform& end = (*pipeline)->model().trajectory.poses().back().T_world_depth;
    state.counters["tracked"] = static_cast<double>((*pipeline)->model().counts.depth_tracked);
    state.counters["drift_mm"] =
        1e3 * (end.translation() - Eigen::Vector3d((frames - 1) * kStep, 0.0, 0.0)).norm();
    state.counters["resident_mib"] = ResidentMib();
    state.counters["spilled"] = static_cast<double>((*pipeline)->model().spiller.spilled());
    state.counters["voxel_sum"] = VoxelSum((*pipeline)->model().tsdf());
    state.counters["blocks"] = static_cast<double>((*pipeline)->model().tsdf().block_count());
    state.counters["last_period_p50_ms"] = TakeMedian(last_period_ms);
    for (const Stage stage : AllValues<Stage>()) {
      if (const StageStats* stats = (*pipeline)->model().stages[stage])
        state.counters[std::string(ToString(stage)) + "_p50_ms"] = stats->Percentile(50);
    }
  }
}

// Six metres of wall, without and with a limit: the same voxels.
BENCHMARK(Growth)
    ->Name("BM_LongWall")
    ->ArgNames({"periods", "length_cm", "limit_mib"})
    ->Args({25, 696, 0})
    ->Args({25, 696, 100})
    ->Iterations(1)
    ->Unit(benchmark::kSecond)
    ->UseRealTime();

// Ten times the way in four times the volume.
BENCHMARK(Growth)
    ->Name("BM_Growth")
    ->ArgNames({"periods", "length_cm", "limit_mib"})
    ->Args({1, 96, 0})
    ->Args({10, 384, 0})
    ->Iterations(1)
    ->Repetitions(3)
    ->ReportAggregatesOnly()
    ->Unit(benchmark::kSecond)
    ->UseRealTime();

}  // namespace
}  // namespace isotherm
