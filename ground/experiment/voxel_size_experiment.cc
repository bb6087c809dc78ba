#include <fmt/format.h>

#include <array>

#include "common/base/units.h"
#include "ground/experiment/experiment.h"
#include "ground/experiment/experiment_scan.h"
#include "ground/experiment/relief_target.h"

namespace isotherm {
namespace {

// Those of the thesis, and what the scan volume has by default.
constexpr std::array kVoxels_m = {0.0045, 0.0020, 0.0015, 0.0005};
constexpr std::size_t kCoarse = 0, kDefault = 1, kMedium = 2, kFine = 3;
constexpr double kDuration_s = 2.0, kDistance_m = 0.50;

ScanPath AroundRelief() {
  ScanPath path = TowardsRelief({kDistance_m});
  path.azimuth_rad = FromTo(-8.0 * kRadPerDeg, 8.0 * kRadPerDeg, kDuration_s);
  path.elevation_rad = FromTo(-4.0 * kRadPerDeg, 6.0 * kRadPerDeg, kDuration_s);
  return path;
}

}  // namespace

Result<ExperimentReport> RunVoxelSizeExperiment(ThreadPool& pool) {
  SimulationOptions cameras = ExperimentCameras(kDuration_s, kDistance_m);
  cameras.mutable_thermal()->set_rate_hz(1.0);  // Shape is all that matters.
  std::vector<GroundOptions> options(kVoxels_m.size());
  for (std::size_t i = 0; i < kVoxels_m.size(); ++i)
    options[i].mutable_volume()->set_voxel_size_m(kVoxels_m[i]);
  const auto played = Play(cameras, MakeReliefTarget(AroundRelief()), options, pool);
  if (!played) return Err(played.error());
  ExperimentReport report;
  report.table.rows_are = "voxel";
  report.table.columns = {"height of ridges kept [%]", "flat part, rms [mm]", "scene, rms [mm]",
                          "points"};
  std::array<ReliefCheck, kVoxels_m.size()> checks;
  for (std::size_t i = 0; i < checks.size(); ++i) {
    checks[i] = MeasureRelief(*played->scan, played->pipelines[i]->model(), pool);
    report.table.rows.push_back({fmt::format("{:.1f} mm", 1e3 * kVoxels_m[i]),
                                 {checks[i].kept_percent, checks[i].flat_rms_mm,
                                  checks[i].scene_rms_mm, checks[i].points}});
  }
  const Requirement detail = {"height of ridges kept, voxels of 1.5 mm",
                              checks[kMedium].kept_percent, Requirement::Sense::kAtLeast, 90.0,
                              "%"};
  const Requirement noise = {"scene, rms, voxels of 2 mm", checks[kDefault].scene_rms_mm,
                             Requirement::Sense::kAtMost, 0.25, "mm"};
  report.requirements = {
      detail,
      NegativeControl(detail, "height of ridges kept, voxels of 4.5 mm",
                      checks[kCoarse].kept_percent),
      noise, NegativeControl(noise, "scene, rms, voxels of 0.5 mm", checks[kFine].scene_rms_mm)};
  return report;
}

}  // namespace isotherm
