// The same depth frames through our line and through Open3D's, frame by frame in one run, so that
// both meet the same machine. Prints the median of each stage and the error of both trajectories.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <chrono>
#include <cstdio>
#include <thread>

#include "common/options/override.h"
#include "ground/cli/command.h"
#include "ground/cli/numbers.h"
#include "ground/evaluation/trajectory_evaluation.h"
#include "ground/evaluation/true_poses.h"
#include "ground/pipeline/ground_pipeline.h"
#include "ground/scan/scan_model.h"
#include "ground/tsdf/tsdf_integrator.h"
#include "tests/benchmark/frames.h"
#include "tests/benchmark/machine.h"
#include "tests/benchmark/open3d_fusion.h"

namespace isotherm {
namespace {

struct Arguments {
  std::string scan, volume_min;
  std::size_t frames = 0;
  int threads = 2;
  std::vector<std::string> overrides;
};

/// Threads of the library that just finished spin for a moment; let them rest before the other one
/// is measured.
void Rest() { std::this_thread::sleep_for(std::chrono::milliseconds(10)); }

Result<GroundOptions> Options(const Arguments& arguments) {
  GroundOptions options;
  options.set_threads(arguments.threads);
  // Both integrate every frame.
  TsdfOptions& tsdf = *options.mutable_tsdf();
  tsdf.mutable_expert()->set_min_step_m(0.0);
  tsdf.mutable_expert()->set_max_step_m(0.0);
  tsdf.mutable_expert()->set_min_step_deg(0.0);
  tsdf.mutable_expert()->set_max_step_deg(0.0);
  for (const std::string& assignment : arguments.overrides) {
    if (Status status = ApplyOverride(assignment, options); !status.ok()) return Err(status);
  }
  if (!arguments.volume_min.empty()) {
    const auto corner = ParseNumbers(arguments.volume_min, {3}, "--volume-min");
    if (!corner) return Err(corner.error());
    options.mutable_volume()->mutable_expert()->set_min_x_m((*corner)[0]);
    options.mutable_volume()->mutable_expert()->set_min_y_m((*corner)[1]);
    options.mutable_volume()->mutable_expert()->set_min_z_m((*corner)[2]);
  }
  return options;
}

/// The true pose of the first frame, if it is known and known to fit the volume.
std::optional<RigidTransform> FirstPose(const Arguments& arguments, const BenchmarkFrames& frames) {
  if (!arguments.scan.empty() && arguments.volume_min.empty()) return std::nullopt;
  const Result<RigidTransform> pose =
      PoseAt(frames.truth, frames.depth.front().header.capture_time);
  return pose ? std::optional(*pose) : std::nullopt;
}

/// Both systems after the run.
struct Comparison {
  std::unique_ptr<GroundPipeline> ours;
  std::unique_ptr<Open3dFusion> open3d;
  StageStats full_cast;  ///< Our model at the depth image's size, which no stage needs.
};

Result<Comparison> Run(const GroundOptions& options, const BenchmarkFrames& frames,
                       const std::optional<RigidTransform>& first_pose) {
  Result<std::unique_ptr<GroundPipeline>> ours =
      GroundPipeline::Create(options, frames.rig, first_pose);
  if (!ours) return Err(ours.error());
  Comparison result;
  result.ours = std::move(*ours);
  for (const DepthFrame& frame : frames.depth) {
    result.ours->ProcessDepth(frame);
    const auto start = std::chrono::steady_clock::now();
    const ScanModel scan = result.ours->model();
    CastFullView(scan, options.raycast().expert().min_weight());
    result.full_cast.Add(
        std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start)
            .count());
    Rest();
    if (scan.trajectory.poses().empty())
      return Err(FailedPrecondition("the first frame has too little depth in the volume"));
    if (!result.open3d) {
      const Open3dFusion::Options theirs{scan.tsdf().grid(),
                                         TruncationDistance(options.tsdf(), options.volume()),
                                         frames.rig.depth_sensor.min_depth_m,
                                         frames.rig.depth_sensor.max_depth_m, options.threads()};
      result.open3d = std::make_unique<Open3dFusion>(theirs, frames.rig.depth->WithoutDistortion(),
                                                     scan.trajectory.poses().front().T_world_depth);
    }
    result.open3d->Process(frame);
    Rest();
  }
  return result;
}

double Median(const StageStats& stats) { return stats.Percentile(50.0); }

void PrintRow(const char* stage, double ours_ms, double open3d_ms) {
  fmt::print("{:<34}{:>12.2f}{:>12.2f}{:>10.1f}\n", stage, ours_ms, open3d_ms, open3d_ms / ours_ms);
}

void PrintTimes(const Comparison& run) {
  const auto ours = [&](Stage stage) {
    const StageStats* stats = run.ours->model().stages[stage];
    return stats == nullptr ? 0.0 : Median(*stats);
  };
  const FusionTimes& open3d = run.open3d->times();
  fmt::print("{:<34}{:>12}{:>12}{:>10}\n", "median ms per frame", "isotherm", "Open3D", "ratio");
  PrintRow("tracking with preprocessing", ours(Stage::kPreprocess) + ours(Stage::kTrack),
           Median(open3d.track));
  PrintRow("integration with allocation", ours(Stage::kIntegrate), Median(open3d.integrate));
  PrintRow("ray cast as each tracks against", ours(Stage::kRaycast), Median(open3d.raycast));
  PrintRow("depth frame", ours(Stage::kDepthFrame), Median(open3d.frame));
  PrintRow("(ray cast, both full size)", Median(run.full_cast), Median(open3d.raycast));
}

void PrintErrors(const char* name, const std::vector<StampedPose>& trajectory,
                 const std::vector<StampedPose>& truth) {
  std::vector<StampedPose> at_frames;
  for (const StampedPose& pose : trajectory) {
    if (const auto true_pose = PoseAt(truth, pose.time))
      at_frames.push_back({pose.time, *true_pose});
  }
  const Result<TrajectoryErrors> errors = EvaluateTrajectory(trajectory, at_frames, {});
  if (!errors) return;
  fmt::print("{}: trajectory RMSE {:.3f} mm from the first pose, {:.3f} mm aligned\n", name,
             1e3 * errors->from_first_m.rms, 1e3 * errors->aligned_m.rms);
}

void Print(const Comparison& run, const GroundOptions& options, const BenchmarkFrames& frames) {
  const CameraModel& camera = *frames.rig.depth;
  const Eigen::Vector3d size = run.ours->model().tsdf().grid().size_m();
  fmt::print(
      "{} depth frames, {} x {}, {} threads each, voxels {:g} mm, truncation {:g} mm, "
      "volume {:.2f} x {:.2f} x {:.2f} m\n\n",
      frames.depth.size(), camera.width, camera.height, options.threads(),
      1e3 * options.volume().voxel_size_m(),
      1e3 * TruncationDistance(options.tsdf(), options.volume()), size.x(), size.y(), size.z());
  PrintTimes(run);
  const ScanCounts& counts = run.ours->model().counts;
  fmt::print("\nisotherm: {} of {} frames tracked, {} integrated; Open3D: {} without a solution\n",
             counts.depth_tracked, counts.depth_in, counts.depth_integrated, run.open3d->lost());
  if (frames.truth.empty()) {
    fmt::print("no ground truth: trajectories are not assessed\n");
    return;
  }
  PrintErrors("isotherm", run.ours->model().trajectory.poses(), frames.truth);
  PrintErrors("Open3D", run.open3d->trajectory(), frames.truth);
}

int Main(const Arguments& arguments) {
  const Result<GroundOptions> options = Options(arguments);
  if (!options) return FailConfiguration(options.error().message());
  Result<BenchmarkFrames> loaded;
  if (!arguments.scan.empty()) loaded = LoadDepthFrames(arguments.scan, arguments.frames);
  if (!loaded) return Fail(loaded.error());
  const BenchmarkFrames& frames = arguments.scan.empty() ? FurnaceDoorFrames() : *loaded;
  fmt::print("{}\n", DescribeMachine());
  const Result<Comparison> run = Run(*options, frames, FirstPose(arguments, frames));
  if (!run) return Fail(run.error());
  Print(*run, *options, frames);
  fmt::print("{}\n", DescribeMachine());
  return 0;
}

}  // namespace
}  // namespace isotherm

int main(int argc, char** argv) {
  CLI::App app("Compares our depth line with Open3D's on the same frames");
  isotherm::Arguments arguments;
  app.add_option("scan,--dataset", arguments.scan,
                 "Dataset folder or recording (.mcap); without one the simulated furnace door");
  app.add_option("--frames", arguments.frames, "Only the first this many depth frames; 0 = all");
  app.add_option("--threads", arguments.threads, "Threads of each")->check(CLI::PositiveNumber);
  app.add_option("--volume-min", arguments.volume_min,
                 "Corner of the scan volume in the ground truth's world, \"x y z\", metres; both "
                 "then start at the true first pose");
  app.add_option("--set", arguments.overrides, "Override an option: stage.field=value")->take_all();
  CLI11_PARSE(app, argc, argv);
  return isotherm::Main(arguments);
}
