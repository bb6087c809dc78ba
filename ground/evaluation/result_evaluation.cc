#include "ground/evaluation/result_evaluation.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>

#include "common/base/units.h"
#include "common/dataset/trajectory.h"
#include "common/rig/rig_calibration.h"
#include "ground/evaluation/point_sets.h"
#include "ground/evaluation/true_poses.h"
#include "ground/evaluation/uncertainty_text.h"
#include "ground/options/ground_options.pb.h"
#include "ground/results/result_folder.h"
#include "ground/thermal/thermal_options.h"

namespace isotherm {
namespace {

Result<TrajectoryErrors> CompareTrajectory(const EvaluationRequest& request) {
  const std::filesystem::path path = request.result_dir / "trajectory.txt";
  std::error_code error;
  if (!std::filesystem::exists(path, error)) {
    return Err(
        NotFound(fmt::format("{}: no such file; is '{}' the output folder of isotherm reconstruct?",
                             path.string(), request.result_dir.string())));
  }
  const auto estimated = ReadTrajectory(path);
  if (!estimated) return Err(estimated.error());
  const auto truth = ReadTruePoses(request.groundtruth);
  if (!truth) return Err(truth.error());
  TrajectoryEvaluationOptions options;
  options.tolerance = FromSeconds(1e-3 * request.tolerance_ms);
  options.first = request.first;
  if (request.skip_repeats) {
    auto repeats = RepeatedDepthFrames(*request.skip_repeats);
    if (!repeats) return Err(repeats.error());
    options.left_out = std::move(*repeats);
  }
  return EvaluateTrajectory(*estimated, *truth, options);
}

/// A point counts as shown if at least this many true poses show it: one image alone may show it by
/// half a pixel.
constexpr int kMinPoses = 2;
/// Limits that are no result's own, so that results are compared like for like: of what could be
/// measured at all, and of what could be measured well.
constexpr WellSeenLimits kMeasurable{kMinPoses, 0.30, 0.90, 0.0, 60.0};
constexpr WellSeenLimits kMeasurableWell{kMinPoses, 0.30, 0.60, 0.0, 40.0};
// More threads only make the evaluation quicker. Not tuned.
constexpr int kThreads = 2;
// As near as completeness asks (SurfaceEvaluationOptions), two and a half voxels of 2 mm.
constexpr float kCoveredWithin_m = 0.005F;

/// Returns the limits that the result was measured under (stats.json), or the defaults.
Result<WellSeenLimits> LimitsOf(const EvaluationRequest& request, const Rig& rig) {
  const ThermalOptions options =
      ConfigurationOf(request.result_dir).value_or(GroundOptions()).thermal();
  if (Status status = Validate(options); !status.ok())
    return Err(status.WithContext((request.result_dir / "stats.json").string()));
  const ThermalOptions limits = CompleteLimits(options, rig.thermal_sensor);
  return WellSeenLimits{kMinPoses, limits.distance().min_m(), limits.distance().max_m(),
                        limits.angle().min_deg(), limits.angle().max_deg()};
}

Result<std::vector<CoverageUnderLimits>> CompareCoverage(
    const EvaluationRequest& request, const TrueSurface& truth, const MeasuredCloud& cloud,
    const std::vector<Eigen::Vector3f>& positions) {
  const auto rig = LoadRigCalibration(*request.rig);
  if (!rig) return Err(rig.error());
  if (Status status = CheckThermalFusion(*rig); !status.ok()) return Err(std::move(status));
  const auto own = LimitsOf(request, *rig);
  if (!own) return Err(own.error());
  const auto poses = ReadTruePoses(request.groundtruth);
  if (!poses) return Err(poses.error());
  std::vector<RigidTransform> T_truth_thermal;
  for (const StampedPose& pose : *poses)
    T_truth_thermal.push_back(pose.T_world_depth * rig->T_thermal_depth->inverse());
  AssignedPoints assigned;
  for (std::size_t i = 0; i < positions.size(); ++i) {
    if (!std::isfinite(cloud.celsius[i])) continue;
    assigned.positions_m.push_back(positions[i]);
    assigned.good.push_back(QualityOfPoint(cloud, i) == MeasurementQuality::kGood);
  }
  const std::array limits = {*own, kMeasurable, kMeasurableWell};
  ThreadPool pool(kThreads);
  const std::vector<ThermalCoverage> found = EvaluateThermalCoverage(
      truth, {*rig->thermal, T_truth_thermal}, limits, {assigned, kCoveredWithin_m}, pool);
  std::vector<CoverageUnderLimits> result;
  for (std::size_t k = 0; k < limits.size(); ++k) result.push_back({limits[k], found[k]});
  return result;
}

void KeepInside(const Eigen::AlignedBox3f& box, TruePoints& points) {
  TruePoints kept;
  for (std::size_t i = 0; i < points.positions_m.size(); ++i) {
    if (!box.contains(points.positions_m[i])) continue;
    kept.positions_m.push_back(points.positions_m[i]);
    kept.normals.push_back(points.normals[i]);
    kept.primitive.push_back(points.primitive[i]);
    if (!points.celsius.empty()) kept.celsius.push_back(points.celsius[i]);
    if (!points.seen.empty()) kept.seen.push_back(points.seen[i]);
  }
  points = std::move(kept);
}

Status CompareCloud(const EvaluationRequest& request, EvaluationReport& report) {
  const auto cloud = ReadMeasuredCloud(request.result_dir / "cloud.ply");
  if (!cloud) return cloud.error();
  if (cloud->positions_m.empty()) return DataLoss("cloud.ply has no points");
  auto points = ReadTruePoints(*request.surface);
  if (!points) return points.error();
  // Surface outside of the scan volume cannot be in the model; it would count as missing.
  if (request.volume_box) KeepInside(*request.volume_box, *points);
  if (points->positions_m.empty())
    return InvalidArgument("no true surface lies inside the volume box");
  const auto report_fraction = [&request](double fraction) {
    if (request.progress) request.progress(fraction);
  };
  report_fraction(0.1);
  const TrueSurface truth(std::move(*points));
  const std::vector<Eigen::Vector3f> positions =
      // The result's `world` is where the first frame was; the truth has a frame of its own.
      Transformed(report.trajectory.T_truth_world, cloud->positions_m);
  report.cloud_points = positions.size();
  report_fraction(0.2);
  report.surface = EvaluateSurface(positions, truth, {});
  report_fraction(0.7);
  // Without the object's emissivity, true and apparent temperatures cannot be compared.
  if (!request.emissivity) return OkStatus();
  TemperatureEvaluationOptions options;
  options.emissivity = *request.emissivity;
  options.refractive_index = request.refractive_index;
  options.ambient_celsius = request.ambient_celsius;
  options.R_truth_world = report.trajectory.T_truth_world.linear().cast<float>();
  const auto temperature = EvaluateTemperatures(*cloud, positions, truth, options);
  if (!temperature) return temperature.error();
  report.temperature = *temperature;
  if (!request.rig) return OkStatus();
  const auto coverage = CompareCoverage(request, truth, *cloud, positions);
  if (!coverage) return coverage.error();
  report.coverage = *coverage;
  return OkStatus();
}

std::string Line(std::string_view name, const ErrorStatistics& s, double factor,
                 std::string_view unit) {
  return fmt::format("  {:<26}RMS {:.3f}  median {:.3f}  95 % {:.3f}  max {:.3f} {}\n", name,
                     factor * s.rms, factor * s.median, factor * s.p95, factor * s.max, unit);
}

std::string Line(std::string_view name, const TemperatureErrors& errors) {
  if (errors.magnitude.count == 0) return fmt::format("  {:<26}no points\n", name);
  return fmt::format(
      "  {:<26}{} points  median {:.3f}  95 % {:.3f} K  beyond 5 K {:.2f} %  mean {:+.3f} K\n",
      name, errors.magnitude.count, errors.magnitude.median, errors.magnitude.p95,
      100.0 * errors.gross_fraction, errors.mean);
}

Json StatisticsJson(const ErrorStatistics& s) {
  Json json;
  json["count"] = s.count;
  json["rms"] = s.rms;
  json["median"] = s.median;
  json["p95"] = s.p95;
  json["max"] = s.max;
  return json;
}

Json TemperatureJson(const TemperatureErrors& errors) {
  Json json;
  json["count"] = errors.magnitude.count;
  json["median_kelvin"] = errors.magnitude.median;
  json["p95_kelvin"] = errors.magnitude.p95;
  json["mean_kelvin"] = errors.mean;
  json["fraction_beyond_5_k"] = errors.gross_fraction;
  return json;
}

Json ClassJson(const ClassErrors& errors) {
  Json json = TemperatureJson(errors.all);
  json["away_from_edges"] = TemperatureJson(errors.away_from_edges);
  return json;
}

std::string TemperatureText(const TemperatureReport& temperature) {
  std::string text =
      fmt::format("temperature (measured minus expected apparent; {} points were never measured)\n",
                  temperature.never_measured);
  text += Line("good", temperature.good.all);
  text += Line("  away from edges", temperature.good.away_from_edges);
  text += Line("acceptable", temperature.acceptable.all);
  text += Line("  away from edges", temperature.acceptable.away_from_edges);
  text += Line("bad", temperature.bad.all);
  text += Line("  away from edges", temperature.bad.away_from_edges);
  return text + Line("all", temperature.any.all) + ToText(temperature.uncertainty);
}

double Fraction(std::size_t part, std::size_t whole) {
  return static_cast<double>(part) / static_cast<double>(std::max<std::size_t>(1, whole));
}

std::string CoverageText(const std::vector<CoverageUnderLimits>& coverage) {
  std::string text = fmt::format(
      "coverage (true points that the thermal camera saw at least {} times: with a temperature "
      "within {:g} mm, the nearest one measured well)\n",
      kMinPoses, kMmPerM * static_cast<double>(kCoveredWithin_m));
  for (const auto& [limits, part] : coverage) {
    text +=
        fmt::format("  {:<26}{:.2f} %, {:.2f} % of {} points\n",
                    fmt::format("{:.3g}-{:.3g} m, {:g}-{:g} degrees", limits.min_distance_m,
                                limits.max_distance_m, limits.min_angle_deg, limits.max_angle_deg),
                    100.0 * Fraction(part.covered, part.well_seen),
                    100.0 * Fraction(part.measured_well, part.well_seen), part.well_seen);
  }
  return text;
}

Json CoverageJson(const CoverageUnderLimits& part) {
  Json json;
  json["distance_m"] = {part.limits.min_distance_m, part.limits.max_distance_m};
  json["angle_deg"] = {part.limits.min_angle_deg, part.limits.max_angle_deg};
  json["min_poses"] = part.limits.min_poses;
  json["well_seen"] = part.coverage.well_seen;
  json["covered"] = part.coverage.covered;
  json["measured_well"] = part.coverage.measured_well;
  return json;
}

}  // namespace

Result<EvaluationReport> Evaluate(const EvaluationRequest& request) {
  EvaluationReport report;
  auto trajectory = CompareTrajectory(request);
  if (!trajectory) return Err(trajectory.error());
  report.trajectory = std::move(*trajectory);
  if (request.surface) {
    if (Status status = CompareCloud(request, report); !status.ok()) return Err(std::move(status));
  }
  return report;
}

std::string ToText(const EvaluationReport& report) {
  const TrajectoryErrors& t = report.trajectory;
  std::string text = fmt::format(
      "trajectory: {} of {} true poses have a pose ({:.1f} %), path {:.3f} m", t.matched,
      t.truth_poses, 100.0 * static_cast<double>(t.matched) / static_cast<double>(t.truth_poses),
      t.length_m);
  if (t.left_out > 0) text += fmt::format(", {} repeated frames left out", t.left_out);
  if (t.without_truth > 0) text += fmt::format(", {} poses without truth", t.without_truth);
  text += "\n" + Line("rigidly aligned", t.aligned_m, kMmPerM, "mm");
  text += Line("", t.aligned_rad, 1.0 / kRadPerDeg, "degrees");
  text += Line("from the first pose", t.from_first_m, kMmPerM, "mm");
  text += Line("", t.from_first_rad, 1.0 / kRadPerDeg, "degrees");
  if (report.surface) {
    const SurfaceErrors& s = *report.surface;
    text += fmt::format("surface: {} points to the true surface\n", report.cloud_points);
    text += Line("from the first pose", s.distance_m, kMmPerM, "mm");
    text += Line("rigidly fitted", s.fitted_distance_m, kMmPerM, "mm");
    text += fmt::format(
        "  {:<26}{:.2f} % of {} true points seen at least 3 times have a point within 5 mm ({:.2f} "
        "% fitted)\n",
        "completeness", 100.0 * s.completeness, s.surface_points, 100.0 * s.fitted_completeness);
  }
  if (report.temperature) text += TemperatureText(*report.temperature);
  if (!report.coverage.empty()) text += CoverageText(report.coverage);
  return text;
}

Json ToJson(const EvaluationReport& report) {
  Json json;
  Json& trajectory = json["trajectory"];
  trajectory["true_poses"] = report.trajectory.truth_poses;
  trajectory["matched"] = report.trajectory.matched;
  trajectory["left_out"] = report.trajectory.left_out;
  trajectory["without_truth"] = report.trajectory.without_truth;
  trajectory["path_m"] = report.trajectory.length_m;
  trajectory["aligned_m"] = StatisticsJson(report.trajectory.aligned_m);
  trajectory["aligned_rad"] = StatisticsJson(report.trajectory.aligned_rad);
  trajectory["from_first_rad"] = StatisticsJson(report.trajectory.from_first_rad);
  trajectory["from_first_m"] = StatisticsJson(report.trajectory.from_first_m);
  if (report.surface) {
    Json& surface = json["surface"];
    surface["points"] = report.cloud_points;
    surface["distance_m"] = StatisticsJson(report.surface->distance_m);
    surface["fitted_distance_m"] = StatisticsJson(report.surface->fitted_distance_m);
    surface["true_points"] = report.surface->surface_points;
    surface["completeness"] = report.surface->completeness;
    surface["fitted_completeness"] = report.surface->fitted_completeness;
  }
  if (report.temperature) {
    Json& temperature = json["temperature"];
    temperature["never_measured"] = report.temperature->never_measured;
    temperature["good"] = ClassJson(report.temperature->good);
    temperature["acceptable"] = ClassJson(report.temperature->acceptable);
    temperature["bad"] = ClassJson(report.temperature->bad);
    temperature["all"] = ClassJson(report.temperature->any);
    temperature["uncertainty"] = ToJson(report.temperature->uncertainty);
  }
  for (const CoverageUnderLimits& part : report.coverage)
    json["coverage"].push_back(CoverageJson(part));
  return json;
}

}  // namespace isotherm
