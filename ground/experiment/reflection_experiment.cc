#include <limits>

#include "common/simulation/scene_builder.h"
#include "ground/experiment/experiment.h"
#include "ground/experiment/experiment_scan.h"
#include "ground/experiment/model_check.h"
#include "ground/renderer/renderer.h"

namespace isotherm {
namespace {

constexpr double kDuration_s = 5.0;
constexpr const char* kPatch = "polished patch";
constexpr double kShowsPipe_celsius = 80.0;

/// A painted door with a polished patch that mirrors a hot pipe in front of it. The rig goes around
/// the patch, and the pipe's image wanders over all of it.
StagedScene DoorWithPolishedPatch() {
  SceneBuilder scene(23.0);
  scene.UseMaterial({0.96, 1.5, 0.0, false});
  scene.Box("door", {0.02, 0.02, 0.74}, {0.94, 0.94, 0.80}).temperature = Uniform(60.0);
  scene.Box("sill", {0.02, 0.64, 0.60}, {0.94, 0.70, 0.74}).temperature = Uniform(60.0);
  scene.RotatedBox("carton", {0.66, 0.58, 0.68}, {0.10, 0.12, 0.10}, {0, 25, 0}).temperature =
      Uniform(60.0);
  scene.RotatedBox("hinge", {0.58, 0.30, 0.71}, {0.14, 0.06, 0.06}, {0, 0, 20}).temperature =
      Uniform(60.0);
  scene.Sphere("knob", {0.70, 0.42, 0.72}, 0.05).temperature = Uniform(60.0);
  scene.Cylinder("pipe", {0.40, 0.06, 0.56}, {0.40, 0.64, 0.56}, 0.02).temperature = Uniform(130.0);
  // Rough metal under paint does not mirror; this does.
  scene.UseMaterial({0.40, 1.5, 0.0, true});
  scene.Box(kPatch, {0.45, 0.44, 0.734}, {0.53, 0.52, 0.741}).temperature = Uniform(60.0);
  ScanPath path;
  path.target_x_m = {0.49};
  path.target_y_m = {0.48};
  path.target_z_m = {0.74};
  path.azimuth_rad = FromTo(0.02, 0.72, kDuration_s - 0.4);
  path.elevation_rad = {0.05, 0.04, 2.0};
  path.distance_m = {0.56};
  return {scene.Build("door with a polished patch"), path, {}};
}

bool IsOnPatch(const Scene& scene, const CheckedPoint& point) {
  return scene.primitives()[static_cast<std::size_t>(point.truth.primitive)].name == kPatch;
}

/// The disagreement layer as a test for "this surface reflects".
struct Detection {
  double reflecting = 0.0;  ///< Points of the patch that were assessed.
  double found = 0.0;       ///< Those called bad.
  double false_alarms = 0.0;
  double others = 0.0;
  double shows_pipe = 0.0;  ///< Points of the patch, assessed or not, with the pipe's temperature.

  double PrecisionPercent() const { return Percent(found, found + false_alarms); }
  double RecallPercent() const { return Percent(found, reflecting); }
  static double Percent(double part, double whole) {
    return whole == 0.0 ? std::numeric_limits<double>::quiet_NaN() : 100.0 * part / whole;
  }
};

Detection Detect(const Scene& scene, const std::vector<CheckedPoint>& points) {
  Detection detection;
  for (const CheckedPoint& point : points) {
    const bool reflects = IsOnPatch(scene, point);
    if (reflects && point.measured() && point.point.celsius > kShowsPipe_celsius)
      detection.shows_pipe += 1.0;
    const auto disagreement = static_cast<ConditionClass>(point.point.disagreement_class);
    if (disagreement == ConditionClass::kUnchecked) continue;
    (reflects ? detection.reflecting : detection.others) += 1.0;
    if (disagreement == ConditionClass::kBad)
      (reflects ? detection.found : detection.false_alarms) += 1.0;
  }
  return detection;
}

ExperimentTable::Row DescribeDetection(const char* label, const Detection& detection) {
  return {label,
          {detection.reflecting, detection.found, detection.others, detection.false_alarms,
           detection.PrecisionPercent(), detection.RecallPercent(), detection.shows_pipe}};
}

}  // namespace

Result<ExperimentReport> RunReflectionExperiment(ThreadPool& pool) {
  GroundOptions lowest;
  lowest.mutable_thermal()->mutable_expert()->set_policy(LOWEST_GOOD);
  const auto played = Play(ExperimentCameras(kDuration_s), DoorWithPolishedPatch(),
                           {GroundOptions(), lowest}, pool);
  if (!played) return Err(played.error());
  const SimulatedScan& scan = *played->scan;
  ExperimentReport report;
  report.table.rows_are = "temperature kept";
  report.table.columns = {"patch points assessed",         "found",         "other points assessed",
                          "falsely called reflecting",     "precision [%]", "recall [%]",
                          "patch points warmer than 80 °C"};
  const Renderer renderer(FixedScale(23.0, 130.0), ThermalOptions());
  constexpr const char* kLabels[] = {"best conditions", "lowest of the good"};
  constexpr const char* kRenderings[] = {"best_conditions", "lowest"};
  Detection best_conditions;
  for (std::size_t i = 0; i < 2; ++i) {
    const ScanModel model = played->pipelines[i]->model();
    const Detection detection = Detect(
        scan.scene(), CheckModel(scan.scene(), scan.band(), model.tsdf(), model.thermal(), pool));
    report.table.rows.push_back(DescribeDetection(kLabels[i], detection));
    const ViewMaps view = LookAtModel(model, scan, scan.depth_times().back().exposure, pool);
    report.renderings.push_back({kRenderings[i], renderer.Thermal(view)});
    if (i > 0) continue;
    best_conditions = detection;
    report.renderings.push_back({"disagreement", renderer.Disagreement(view)});
  }
  using Sense = Requirement::Sense;
  report.requirements = {
      {"precision of the disagreement layer", best_conditions.PrecisionPercent(), Sense::kAtLeast,
       90.0, "%"},
      {"recall of the disagreement layer", best_conditions.RecallPercent(), Sense::kAtLeast, 90.0,
       "%"},
      {"patch points assessed", best_conditions.reflecting, Sense::kAtLeast, 1000.0, ""}};
  return report;
}

}  // namespace isotherm
