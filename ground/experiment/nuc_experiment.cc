#include "ground/experiment/corner_scene.h"
#include "ground/experiment/experiment.h"
#include "ground/experiment/experiment_scan.h"
#include "ground/experiment/model_check.h"
#include "ground/renderer/renderer.h"

namespace isotherm {
namespace {

constexpr double kDuration_s = 4.9;
// A shutter as warm as no part of the scene, so that its temperature shows wherever it got in.
constexpr double kShutter_celsius = 60.0;
/// Nothing in the scene is warmer than 30 °C: what is warmer than this was read off the shutter.
constexpr double kFromShutter_celsius = 45.0;

StagedScene CoolCorner() {
  return CornerScene("cool corner",
                     {.back_wall = 24.0, .side_wall = 28.0, .floor = 26.0, .sphere = 30.0});
}

/// Three closings of 0.4, 0.7 and 1.0 s.
SimulationOptions CamerasWithShutter() {
  SimulationOptions options = ExperimentCameras(kDuration_s, kSharpEverywhere);
  ShutterOptions& shutter = *options.mutable_shutter();
  shutter.set_first_s(0.8);
  shutter.set_interval_s(1.4);
  shutter.set_duration_s(0.4);
  shutter.mutable_expert()->set_duration_step_s(0.3);
  shutter.mutable_expert()->set_appearance(ShutterOptions::SHUTTER);
  shutter.mutable_expert()->set_shutter_celsius(kShutter_celsius);
  return options;
}

/// Voxels anywhere in the model, and those of them with the shutter's temperature.
struct VoxelCount {
  double measured = 0.0;
  double from_shutter = 0.0;
};
VoxelCount CountVoxels(const ScanModel& model) {
  VoxelCount count;
  for (std::int32_t block = 0; block < model.tsdf().block_count(); ++block) {
    for (const ThermalVoxel& voxel : model.thermal().voxels(block)) {
      count.measured += voxel.measured() ? 1.0 : 0.0;
      count.from_shutter += voxel.celsius() > kFromShutter_celsius ? 1.0 : 0.0;
    }
  }
  return count;
}

double LeftOutForNuc(const ScanModel& model) {
  return static_cast<double>(model.counts.thermal_left_out[LeftOutReason::kNuc]);
}

/// `all`: voxels measured if every frame is believed.
ExperimentTable::Row DescribeModel(const char* label, const ScanModel& model, double all) {
  const VoxelCount voxels = CountVoxels(model);
  return {label,
          {static_cast<double>(model.counts.thermal_fused), LeftOutForNuc(model), voxels.measured,
           voxels.from_shutter, 100.0 * voxels.measured / all}};
}

/// Frames while the shutter was closed.
struct WhileClosed {
  double thermal_frames = 0.0;
  double depth_frames = 0.0;
  double tracked = 0.0;  ///< Part of the depth frames.
};

/// The table and what is required of it.
ExperimentReport Describe(const ScanModel& ignored, const ScanModel& respected,
                          const WhileClosed& seen) {
  ExperimentReport report;
  report.table.rows_are = "frames of the closed shutter";
  report.table.columns = {"thermal frames fused", "left out for NUC", "voxels measured",
                          "voxels with the shutter's temperature", "coverage [% of believed]"};
  const double all = CountVoxels(ignored).measured;
  report.table.rows = {DescribeModel("believed", ignored, all),
                       DescribeModel("left out", respected, all)};
  const ScanCounts& counts = respected.counts;
  const Requirement from_shutter = {"voxels with the shutter's temperature",
                                    report.table.rows[1].values[3], Requirement::Sense::kAtMost,
                                    0.0, ""};
  report.requirements = {
      from_shutter,
      NegativeControl(from_shutter, "the same if frames of the closed shutter are believed",
                      report.table.rows[0].values[3]),
      {"coverage of what all frames together measure", report.table.rows[1].values[4],
       Requirement::Sense::kAtLeast, 90.0, "%"},
      {"frames of the closed shutter not left out", seen.thermal_frames - LeftOutForNuc(respected),
       Requirement::Sense::kAtMost, 0.0, ""},
      {"depth frames not tracked", static_cast<double>(counts.depth_in - counts.depth_tracked),
       Requirement::Sense::kAtMost, 0.0, ""},
      {"depth frames tracked while the shutter was closed",
       100.0 * seen.tracked / seen.depth_frames, Requirement::Sense::kAtLeast, 100.0, "%"}};
  return report;
}

}  // namespace

Result<ExperimentReport> RunNucExperiment(ThreadPool& pool) {
  const auto scan = SimulatedScan::Create(CamerasWithShutter(), CoolCorner());
  if (!scan) return Err(scan.error());
  const auto respected = StartPipeline({}, **scan, pool);
  const auto ignored = StartPipeline({}, **scan, pool);
  if (!respected) return Err(respected.error());
  if (!ignored) return Err(ignored.error());
  WhileClosed seen;
  PlayScan(**scan, pool,
           {[&](const DepthFrame& frame) {
              const bool tracked = (*respected)->ProcessDepth(frame).tracked;
              (*ignored)->ProcessDepth(frame);
              if (!(*scan)->IsShutterClosed(frame.header.capture_time)) return;
              seen.depth_frames += 1.0;
              seen.tracked += tracked ? 1.0 : 0.0;
            },
            [&](const ThermalFramePtr& frame) {
              seen.thermal_frames += frame->valid ? 0.0 : 1.0;
              (*respected)->ProcessThermal(frame);
              auto trusted = std::make_shared<ThermalFrame>(*frame);
              trusted->valid = true;
              (*ignored)->ProcessThermal(std::move(trusted));
            }});
  for (const auto* pipeline : {&*respected, &*ignored}) (*pipeline)->Finish();

  ExperimentReport report = Describe((*ignored)->model(), (*respected)->model(), seen);
  report.requirements.push_back({"NUC events in mid-scan",
                                 static_cast<double>((*scan)->nuc_events().size()),
                                 Requirement::Sense::kAtLeast, 3.0, ""});
  const Renderer renderer(FixedScale(20.0, kShutter_celsius), ThermalOptions());
  const auto rendering = [&](const ScanModel& model) {
    return renderer.Thermal(
        LookAtModel(model, **scan, (*scan)->depth_times().back().exposure, pool));
  };
  report.renderings = {{"believed", rendering((*ignored)->model())},
                       {"left_out", rendering((*respected)->model())}};
  return report;
}

}  // namespace isotherm
