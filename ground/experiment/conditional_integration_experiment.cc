#include <array>

#include "ground/experiment/experiment.h"
#include "ground/experiment/experiment_scan.h"
#include "ground/experiment/relief_target.h"

namespace isotherm {
namespace {

constexpr double kDuration_s = 4.0, kVoxel_m = 0.0016;
constexpr double kFar_m = 1.00, kNear_m = 0.50;
/// A depth camera that reads its rows one after the other, so that fast motion bends its images.
constexpr double kReadout_s = 0.030;

/// To and fro at up to 0.6 m/s, twice what is integrated, and slow where it turns.
ScanPath Hasty(double distance_m) {
  ScanPath path = TowardsRelief({distance_m});
  path.target_x_m = {0.48, 0.10, 1.05};
  path.target_y_m = {0.52, 0.04, 0.83};
  return path;
}

GroundOptions Conditional(bool conditional) {
  GroundOptions options;
  options.mutable_volume()->set_voxel_size_m(kVoxel_m);
  options.mutable_tsdf()->mutable_expert()->set_truncation_distance_m(0.008);
  if (!conditional) {
    options.mutable_tsdf()->mutable_expert()->set_max_step_m(0.0);
    options.mutable_tsdf()->mutable_expert()->set_max_step_deg(0.0);
  }
  return options;
}

}  // namespace

Result<ExperimentReport> RunConditionalIntegrationExperiment(ThreadPool& pool) {
  SimulationOptions cameras = ExperimentCameras(kDuration_s, kFar_m);
  cameras.mutable_thermal()->set_rate_hz(1.0);  // Shape is all that matters.
  cameras.mutable_depth()->mutable_expert()->set_readout_s(kReadout_s);
  const auto far =
      Play(cameras, MakeReliefTarget(Hasty(kFar_m)), {Conditional(false), Conditional(true)}, pool);
  if (!far) return Err(far.error());
  const auto near = Play(cameras, MakeReliefTarget(Hasty(kNear_m)), {Conditional(true)}, pool);
  if (!near) return Err(near.error());
  const std::array checks = {MeasureRelief(*far->scan, far->pipelines[0]->model(), pool),
                             MeasureRelief(*far->scan, far->pipelines[1]->model(), pool),
                             MeasureRelief(*near->scan, near->pipelines[0]->model(), pool)};
  constexpr std::array kNames = {"1.0 m, all frames", "1.0 m, slow frames only",
                                 "0.5 m, slow frames only"};
  ExperimentReport report;
  report.table.rows_are = "integrated";
  report.table.columns = {"height of ridges kept [%]", "flat part, rms [mm]", "scene, rms [mm]",
                          "points"};
  for (std::size_t i = 0; i < checks.size(); ++i) {
    report.table.rows.push_back({kNames[i],
                                 {checks[i].kept_percent, checks[i].flat_rms_mm,
                                  checks[i].scene_rms_mm, checks[i].points}});
  }
  const Requirement shape = {"scene, rms, slow frames only", checks[1].scene_rms_mm,
                             Requirement::Sense::kAtMost, 1.0, "mm"};
  report.requirements = {
      shape,
      NegativeControl(shape, "scene, rms, all frames", checks[0].scene_rms_mm),
      {"scene, rms, from 0.5 m", checks[2].scene_rms_mm, Requirement::Sense::kAtMost, 1.0, "mm"}};
  return report;
}

}  // namespace isotherm
