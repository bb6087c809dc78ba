#include <cmath>

#include "ground/experiment/bar_wall.h"
#include "ground/experiment/experiment.h"
#include "ground/experiment/experiment_scan.h"
#include "ground/experiment/model_check.h"
#include "ground/renderer/renderer.h"

namespace isotherm {
namespace {

constexpr double kDuration_s = 3.2, kDistance_m = 0.52;
/// Time constant of the simulated detector; the pipeline is told the same.
constexpr double kTimeConstant_s = 0.010;
/// No smear is too much.
constexpr double kAnySmear_px = 1e6;

/// The rig sweeps along the bars at up to 0.8 m/s, resting for a moment at either end.
StagedScene SweepAlongBars() {
  SceneBuilder scene = BarWall::Make();
  ScanPath path;
  path.target_x_m = {0.48, 0.16, 1.25};
  path.target_y_m = {0.52};
  path.target_z_m = {BarWall::kWall_m};
  path.distance_m = {kDistance_m};
  return {scene.Build("sweep along bars"), path, {}};
}

SimulationOptions CamerasWithInertia() {
  SimulationOptions options = ExperimentCameras(kDuration_s, kDistance_m);
  options.mutable_thermal()->mutable_expert()->set_time_constant_s(kTimeConstant_s);
  return options;
}

GroundOptions WithSmearLimits(bool limited) {
  GroundOptions options;
  // The simulated depth camera has no shutter of rows: faster motion is good enough here.
  options.mutable_tsdf()->mutable_expert()->set_max_step_m(0.04);
  if (!limited) {
    options.mutable_thermal()->mutable_expert()->mutable_motion()->set_smear_good_px(kAnySmear_px);
    options.mutable_thermal()->mutable_expert()->mutable_motion()->set_smear_max_px(kAnySmear_px);
  }
  return options;
}

/// Nearer to the border between two bars, a voxel and a thermal pixel show both: that is a matter
/// of resolution (the distance experiment), not of motion.
constexpr double kBorder_m = 0.004;

bool IsAtBorder(const CheckedPoint& point) {
  const double bars = (point.truth.p_world.x() - BarWall::kFirst_m) / BarWall::kBar_m;
  return std::abs(bars - std::round(bars)) * BarWall::kBar_m < kBorder_m;
}

ExperimentTable::Row DescribeModel(const char* label, const PlayedScan& played,
                                   const ScanModel& model, ThreadPool& pool) {
  std::vector<CheckedPoint> points =
      CheckModel(played.scan->scene(), played.scan->band(), model.tsdf(), model.thermal(), pool);
  std::erase_if(points, IsAtBorder);
  const ErrorSummary errors = SummarizeErrors(points);
  return {label,
          {static_cast<double>(points.size()), static_cast<double>(errors.measured),
           static_cast<double>(model.counts.fusion.smeared), errors.median_k, errors.p999_k,
           errors.largest_k, MeasuredPercent(points), errors.within_sigma_percent,
           errors.within_1_96_sigma_percent}};
}

std::vector<Requirement> Require(const ExperimentTable& table) {
  const auto value = [&](std::size_t row, std::size_t column) {
    return table.rows[row].values[column];
  };
  const Requirement error = {"error of 99.9 % of what remains", value(1, 4),
                             Requirement::Sense::kAtMost, 1.0, "K"};
  return {error,
          NegativeControl(error, "the same of what is believed without limits", value(0, 4)),
          {"smeared pixels left out", value(1, 2), Requirement::Sense::kAtLeast, 1.0, ""},
          // The limit must not win by leaving surfaces without temperatures.
          {"assigned with limits, of what is assigned without", 100.0 * value(1, 1) / value(0, 1),
           Requirement::Sense::kAtLeast, 50.0, "%"}};
}

}  // namespace

Result<ExperimentReport> RunMotionExperiment(ThreadPool& pool) {
  const auto played = Play(CamerasWithInertia(), SweepAlongBars(),
                           {WithSmearLimits(false), WithSmearLimits(true)}, pool);
  if (!played) return Err(played.error());
  ExperimentReport report;
  report.table.rows_are = "smeared pixels";
  report.table.columns = {"points",           "assigned",         "smeared pixels left out",
                          "median error [K]", "99.9 % error [K]", "largest error [K]",
                          "coverage [%]",     "within sigma [%]", "within 1.96 sigma [%]"};
  RendererOptions renderer_options = FixedScale(BarWall::kCold_celsius, BarWall::kHot_celsius);
  renderer_options.mutable_expert()->set_shading(false);
  const Renderer renderer(renderer_options, ThermalOptions());
  constexpr const char* kLabels[] = {"believed", "left out"};
  constexpr const char* kRenderings[] = {"believed", "left_out"};
  for (std::size_t i = 0; i < 2; ++i) {
    const ScanModel model = played->pipelines[i]->model();
    report.table.rows.push_back(DescribeModel(kLabels[i], *played, model, pool));
    report.renderings.push_back(
        {kRenderings[i],
         renderer.Thermal(LookAtModel(model, *played->scan,
                                      played->scan->depth_times().front().exposure, pool))});
  }
  report.requirements = Require(report.table);
  return report;
}

}  // namespace isotherm
