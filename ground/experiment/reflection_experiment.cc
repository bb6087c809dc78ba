#include "common/simulation/scene_builder.h"
#include "ground/experiment/experiment.h"
#include "ground/experiment/experiment_scan.h"
#include "ground/experiment/model_check.h"
#include "ground/renderer/renderer.h"

namespace isotherm {
namespace {

constexpr double kDuration_s = 5.0, kDistance_m = 0.56;
constexpr const char* kPatch = "polished patch";
// Only the mirrored pipe looks as hot.
constexpr double kShowsPipe_celsius = 80.0;

/// A painted door with a patch that mirrors a hot pipe in front of it, or is painted as well. The
/// rig goes around the patch, and the pipe's image wanders over all of it.
StagedScene DoorWithPatch(bool polished) {
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
  if (polished) scene.UseMaterial({0.40, 1.5, 0.0, true});
  scene.Box(kPatch, {0.45, 0.44, 0.734}, {0.53, 0.52, 0.741}).temperature = Uniform(60.0);
  ScanPath path;
  path.target_x_m = {0.49};
  path.target_y_m = {0.48};
  path.target_z_m = {0.74};
  path.azimuth_rad = FromTo(0.02, 0.72, kDuration_s - 0.4);
  path.elevation_rad = {0.05, 0.04, 2.0};
  path.distance_m = {kDistance_m};
  return {scene.Build("door with a polished patch"), path, {}};
}

bool IsOnPatch(const Scene& scene, const CheckedPoint& point) {
  return scene.primitives()[static_cast<std::size_t>(point.truth.primitive)].name == kPatch;
}

/// Points of one surface, by what the disagreement layer says.
struct AssessedPoints {
  std::size_t bad = 0;           ///< Called reflecting.
  std::size_t not_bad = 0;       ///< Called even.
  std::size_t not_assessed = 0;  ///< Measured under good conditions too rarely to say.

  std::size_t all() const { return bad + not_bad + not_assessed; }
};

/// The disagreement layer as a test for "this surface reflects".
struct Detection {
  AssessedPoints patch, others;
  std::size_t shows_pipe = 0;  ///< Points of the patch with the pipe's temperature.

  double PrecisionPercent() const { return Percent(patch.bad, patch.bad + others.bad); }
  double RecallPercent() const { return Percent(patch.bad, patch.bad + patch.not_bad); }
  /// Returns the fraction of all the patch's points that were found; a point that was not assessed
  /// counts as not found.
  double FoundOfAllPercent() const { return Percent(patch.bad, patch.all()); }
};

Detection Detect(const Scene& scene, const std::vector<CheckedPoint>& points) {
  Detection detection;
  for (const CheckedPoint& point : points) {
    const bool reflects = IsOnPatch(scene, point);
    if (reflects && point.measured() && point.point.celsius > kShowsPipe_celsius)
      ++detection.shows_pipe;
    AssessedPoints& assessed = reflects ? detection.patch : detection.others;
    switch (static_cast<ConditionClass>(point.point.disagreement_class)) {
      case ConditionClass::kBad:
        ++assessed.bad;
        break;
      case ConditionClass::kUnchecked:
        ++assessed.not_assessed;
        break;
      default:
        ++assessed.not_bad;
    }
  }
  return detection;
}

ExperimentTable::Row DescribeDetection(const char* label, const Detection& detection) {
  return {label,
          {static_cast<double>(detection.patch.all()),
           static_cast<double>(detection.patch.not_assessed),
           static_cast<double>(detection.patch.bad), static_cast<double>(detection.others.all()),
           static_cast<double>(detection.others.not_assessed),
           static_cast<double>(detection.others.bad), detection.PrecisionPercent(),
           detection.RecallPercent(), detection.FoundOfAllPercent(),
           static_cast<double>(detection.shows_pipe)}};
}

Detection DetectIn(const PlayedScan& played, std::size_t pipeline, ThreadPool& pool) {
  const ScanModel model = played.pipelines[pipeline]->model();
  const Scene& scene = played.scan->scene();
  return Detect(scene, CheckModel(scene, played.scan->band(), model.tsdf(), model.thermal(), pool));
}

}  // namespace

Result<ExperimentReport> RunReflectionExperiment(ThreadPool& pool) {
  GroundOptions lowest;
  lowest.mutable_thermal()->mutable_expert()->set_policy(LOWEST_GOOD);
  const auto played = Play(ExperimentCameras(kDuration_s, kDistance_m), DoorWithPatch(true),
                           {GroundOptions(), lowest}, pool);
  if (!played) return Err(played.error());
  const auto painted = Play(ExperimentCameras(kDuration_s, kDistance_m), DoorWithPatch(false),
                            {GroundOptions()}, pool);
  if (!painted) return Err(painted.error());
  const SimulatedScan& scan = *played->scan;
  ExperimentReport report;
  report.table.rows_are = "temperature kept";
  report.table.columns = {"patch points",
                          "not assessed",
                          "found",
                          "other points",
                          "not assessed",
                          "falsely called reflecting",
                          "precision [%]",
                          "recall of the assessed [%]",
                          "found of all [%]",
                          "patch points warmer than 80 °C"};
  const Renderer renderer(FixedScale(23.0, 130.0), ThermalOptions());
  constexpr const char* kLabels[] = {"best conditions", "lowest of the good"};
  constexpr const char* kRenderings[] = {"best_conditions", "lowest"};
  Detection best_conditions;
  for (std::size_t i = 0; i < 2; ++i) {
    const ScanModel model = played->pipelines[i]->model();
    const Detection detection = DetectIn(*played, i, pool);
    report.table.rows.push_back(DescribeDetection(kLabels[i], detection));
    const ViewMaps view = LookAtModel(model, scan, scan.depth_times().back().exposure, pool);
    report.renderings.push_back({kRenderings[i], renderer.Thermal(view)});
    if (i > 0) continue;
    best_conditions = detection;
    report.renderings.push_back({"disagreement", renderer.Disagreement(view)});
  }
  const Detection control = DetectIn(*painted, 0, pool);
  report.table.rows.push_back(DescribeDetection("best conditions, patch painted", control));
  using Sense = Requirement::Sense;
  const Requirement recall = {"recall of the disagreement layer, of what it assesses",
                              best_conditions.RecallPercent(), Sense::kAtLeast, 90.0, "%"};
  const AssessedPoints& patch = best_conditions.patch;
  const Requirement precision = {"precision of the disagreement layer",
                                 best_conditions.PrecisionPercent(), Sense::kAtLeast, 90.0, "%"};
  const std::size_t assessed_others =
      best_conditions.others.all() - best_conditions.others.not_assessed;
  report.requirements = {
      precision,
      NegativeControl(
          precision, "precision if all that is assessed were called reflecting",
          Percent(patch.bad + patch.not_bad, patch.bad + patch.not_bad + assessed_others)),
      recall,
      NegativeControl(recall, "the same if the patch is painted", control.RecallPercent()),
      {"patch points assessed", static_cast<double>(patch.bad + patch.not_bad), Sense::kAtLeast,
       1000.0, ""}};
  return report;
}

}  // namespace isotherm
