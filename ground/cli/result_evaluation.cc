#include "ground/cli/result_evaluation.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "common/base/units.h"
#include "common/dataset/trajectory.h"
#include "common/rig/rig_calibration.h"
#include "ground/cli/result_folder.h"
#include "ground/cli/truth.h"
#include "ground/evaluation/point_sets.h"
#include "ground/thermal/thermal_options.h"

namespace isotherm {
namespace {

constexpr double kMillimetres = 1e3;

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

/// About this many poses stand for the whole path.
constexpr std::size_t kPosesForCoverage = 40;
constexpr float kCoveredWithin_m = 0.005F;

/// What the result was told to measure under (stats.json), or the defaults.
Result<WellSeenLimits> LimitsOf(const EvaluationRequest& request, const Rig& rig) {
  const ThermalOptions options =
      ConfigurationOf(request.result_dir).value_or(GroundOptions()).thermal();
  if (Status status = Validate(options); !status.ok())
    return Err(status.WithContext((request.result_dir / "stats.json").string()));
  const ThermalOptions limits = CompleteLimits(options, rig.thermal_sensor);
  return WellSeenLimits{limits.distance().min_m(), limits.distance().max_m(),
                        limits.angle().min_deg(), limits.angle().max_deg()};
}

Result<ThermalCoverage> CompareCoverage(const EvaluationRequest& request, const TrueSurface& truth,
                                        const MeasuredCloud& cloud,
                                        const std::vector<Eigen::Vector3f>& positions,
                                        WellSeenLimits& limits) {
  const auto rig = LoadRigCalibration(*request.rig);
  if (!rig) return Err(rig.error());
  if (Status status = CheckThermalFusion(*rig); !status.ok()) return Err(std::move(status));
  const auto known = LimitsOf(request, *rig);
  if (!known) return Err(known.error());
  limits = *known;
  const auto poses = ReadTruePoses(request.groundtruth);
  if (!poses) return Err(poses.error());
  std::vector<RigidTransform> T_truth_thermal;
  const std::size_t step = std::max<std::size_t>(1, poses->size() / kPosesForCoverage);
  for (std::size_t i = 0; i < poses->size(); i += step)
    T_truth_thermal.push_back((*poses)[i].T_world_depth * rig->T_thermal_depth->inverse());
  std::vector<Eigen::Vector3f> assigned;
  for (std::size_t i = 0; i < positions.size(); ++i) {
    if (std::isfinite(cloud.celsius[i])) assigned.push_back(positions[i]);
  }
  return EvaluateThermalCoverage(truth, *rig->thermal, T_truth_thermal, limits, assigned,
                                 kCoveredWithin_m);
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
  if (request.volume_box) KeepInside(*request.volume_box, *points);
  if (points->positions_m.empty())
    return InvalidArgument("no true surface lies inside the volume box");
  const auto report_fraction = [&request](double fraction) {
    if (request.progress) request.progress(fraction);
  };
  report_fraction(0.1);
  const TrueSurface truth(std::move(*points));
  const std::vector<Eigen::Vector3f> positions =
      Transformed(report.trajectory.T_truth_world, cloud->positions_m);
  report.cloud_points = positions.size();
  report_fraction(0.2);
  report.surface = EvaluateSurface(positions, truth, {});
  report_fraction(0.7);
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
  const auto coverage = CompareCoverage(request, truth, *cloud, positions, report.well_seen_limits);
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

Json TableJson(const ErrorTable& table) {
  Json json;
  json["distance_from_m"] = ErrorTable::kFrom_m;
  json["angle_from_deg"] = ErrorTable::kFrom_deg;
  for (const auto& row : table.cells) {
    Json cells;
    for (const ErrorCell& cell : row) {
      Json entry;
      entry["count"] = cell.count;
      entry["median_kelvin"] = cell.median_k;
      entry["p95_kelvin"] = cell.p95_k;
      entry["median_sigma_kelvin"] = cell.median_sigma_k;
      cells.push_back(std::move(entry));
    }
    json["rows"].push_back(std::move(cells));
  }
  return json;
}

Json UncertaintyJson(const UncertaintyReport& report) {
  Json json;
  json["count"] = report.points;
  json["not_known"] = report.unknown;
  json["within_1_sigma"] = report.within_68;
  json["within_1_96_sigma"] = report.within_95;
  json["mean_error_over_sigma"] = report.mean_ratio;
  json["median_sigma_kelvin"] = report.median_sigma_k;
  json["p95_sigma_kelvin"] = report.p95_sigma_k;
  Json& histogram = json["error_over_sigma"];
  histogram["from"] = -Histogram::kEnd;
  histogram["width"] = Histogram::kWidth;
  histogram["counts"] = report.ratios.counts;
  histogram["below"] = report.ratios.below;
  histogram["above"] = report.ratios.above;
  json["absolute_error"] = TableJson(report.table);
  return json;
}

Json ClassJson(const ClassErrors& errors) {
  Json json = TemperatureJson(errors.all);
  json["away_from_edges"] = TemperatureJson(errors.away_from_edges);
  return json;
}

std::string HistogramText(const Histogram& histogram, std::size_t points) {
  constexpr double kPercentPerMark = 0.5;
  std::string text = "  histogram of error / sigma, % of the points\n";
  const auto add = [&](const std::string& range, std::size_t count) {
    const double percent = 100.0 * static_cast<double>(count) / static_cast<double>(points);
    text += fmt::format("  {:>14} {:6.2f} {}\n", range, percent,
                        std::string(static_cast<std::size_t>(percent / kPercentPerMark), '#'));
  };
  add(fmt::format("below {:+.1f}", -Histogram::kEnd), histogram.below);
  for (std::size_t i = 0; i < Histogram::kBins; ++i) {
    const double from = static_cast<double>(i) * Histogram::kWidth - Histogram::kEnd;
    add(fmt::format("{:+.1f} to {:+.1f}", from, from + Histogram::kWidth), histogram.counts[i]);
  }
  add(fmt::format("above {:+.1f}", Histogram::kEnd), histogram.above);
  return text;
}

/// The name of the range that begins at `from[i]`.
template <std::size_t N>
std::string RangeName(const std::array<double, N>& from, std::size_t i, std::string_view unit) {
  if (i + 1 == N) return fmt::format("from {:g} {}", from[i], unit);
  return fmt::format("{:g} to {:g} {}", from[i], from[i + 1], unit);
}

/// No quantiles of a few points.
std::string CellText(const ErrorCell& cell) {
  constexpr std::size_t kFew = 20;
  if (cell.count == 0) return "-";
  if (cell.count < kFew) return fmt::format("- ({})", cell.count);
  return fmt::format("{:.2f} / {:.2f} ({})", cell.median_k, cell.p95_k, cell.count);
}

std::string TableText(const ErrorTable& table) {
  std::string text = "  |error| by distance and angle: median / 95 % in K (points)\n";
  text += fmt::format("  {:>14}", "");
  for (std::size_t column = 0; column < ErrorTable::kFrom_deg.size(); ++column)
    text += fmt::format("{:>24}", RangeName(ErrorTable::kFrom_deg, column, "deg"));
  text += "\n";
  for (std::size_t row = 0; row < ErrorTable::kFrom_m.size(); ++row) {
    text += fmt::format("  {:>14}", RangeName(ErrorTable::kFrom_m, row, "m"));
    for (const ErrorCell& cell : table.cells[row]) text += fmt::format("{:>24}", CellText(cell));
    text += "\n";
  }
  return text;
}

std::string UncertaintyText(const UncertaintyReport& report) {
  if (report.points == 0) {
    return "  uncertainty               the cloud has none (scalar_temperature_sigma)\n" +
           TableText(report.table);
  }
  std::string text = fmt::format(
      "  {:<26}{} points  sigma median {:.3f}  95 % {:.3f} K\n"
      "  {:<26}{:.1f} % within sigma (68.3 if it is right), {:.1f} % within 1.96 sigma (95.0)\n",
      "uncertainty", report.points, report.median_sigma_k, report.p95_sigma_k, "  coverage",
      100.0 * report.within_68, 100.0 * report.within_95);
  return text + HistogramText(report.ratios, report.points) + TableText(report.table);
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
  return text + Line("all", temperature.any.all) + UncertaintyText(temperature.uncertainty);
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
  text += "\n" + Line("rigidly aligned", t.aligned_m, kMillimetres, "mm");
  text += Line("", t.aligned_rad, 1.0 / kRadPerDeg, "degrees");
  text += Line("from the first pose", t.from_first_m, kMillimetres, "mm");
  text += Line("", t.from_first_rad, 1.0 / kRadPerDeg, "degrees");
  if (report.surface) {
    const SurfaceErrors& s = *report.surface;
    text += fmt::format("surface: {} points to the true surface\n", report.cloud_points);
    text += Line("from the first pose", s.distance_m, kMillimetres, "mm");
    text += Line("rigidly fitted", s.fitted_distance_m, kMillimetres, "mm");
    text += fmt::format(
        "  {:<26}{:.2f} % of {} true points seen at least 3 times have a point within 5 mm ({:.2f} "
        "% fitted)\n",
        "completeness", 100.0 * s.completeness, s.surface_points, 100.0 * s.fitted_completeness);
  }
  if (report.temperature) text += TemperatureText(*report.temperature);
  if (report.coverage) {
    const WellSeenLimits& limits = report.well_seen_limits;
    text += fmt::format(
        "  {:<26}{:.2f} % of {} true points seen by the thermal camera from {:.3g} to {:.3g} m at "
        "{:g} to {:g} degrees have a temperature within 5 mm\n",
        "coverage",
        100.0 * static_cast<double>(report.coverage->covered) /
            static_cast<double>(std::max<std::size_t>(1, report.coverage->well_seen)),
        report.coverage->well_seen, limits.min_distance_m, limits.max_distance_m,
        limits.min_angle_deg, limits.max_angle_deg);
  }
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
    temperature["uncertainty"] = UncertaintyJson(report.temperature->uncertainty);
  }
  if (report.coverage) {
    json["coverage"]["well_seen"] = report.coverage->well_seen;
    json["coverage"]["covered"] = report.coverage->covered;
    json["coverage"]["distance_m"] = {report.well_seen_limits.min_distance_m,
                                      report.well_seen_limits.max_distance_m};
    json["coverage"]["angle_deg"] = {report.well_seen_limits.min_angle_deg,
                                     report.well_seen_limits.max_angle_deg};
  }
  return json;
}

namespace {

double Ratio(double part, std::uint64_t whole) {
  return whole == 0 ? std::numeric_limits<double>::quiet_NaN() : part / static_cast<double>(whole);
}

double Ratio(std::uint64_t part, std::uint64_t whole) {
  return Ratio(static_cast<double>(part), whole);
}

}  // namespace

std::string ToText(const HeldOutReport& report) {
  std::string text = fmt::format("held-out views: {} thermal frames predicted", report.frames);
  if (report.without_pose > 0) text += fmt::format(", {} without a pose", report.without_pose);
  text += fmt::format(
      "\n  {:<26}{:.2f} % of {} pixels have a predicted temperature ({:.2f} % of those that show "
      "the model's surface)\n",
      "assigned", 100.0 * Ratio(report.assigned, report.pixels), report.pixels,
      100.0 * Ratio(report.assigned, report.on_surface));
  text += fmt::format("  {:<26}mean of |error| {:.3f} °C, mean {:+.3f} °C\n", "shown - predicted",
                      Ratio(report.sum_of_magnitudes_k, report.assigned),
                      Ratio(report.sum_k, report.assigned));
  if (report.with_sigma == 0) return text;
  return text + fmt::format(
                    "  {:<26}{:.1f} % within sigma, {:.1f} % within 1.96 sigma, mean {:+.2f} "
                    "sigma\n",
                    "error / sigma", 100.0 * Ratio(report.within_68, report.with_sigma),
                    100.0 * Ratio(report.within_95, report.with_sigma),
                    Ratio(report.sum_of_ratios, report.with_sigma));
}

Json ToJson(const HeldOutReport& report) {
  Json json;
  json["frames"] = report.frames;
  json["without_pose"] = report.without_pose;
  json["pixels"] = report.pixels;
  json["pixels_on_surface"] = report.on_surface;
  json["pixels_assigned"] = report.assigned;
  json["assigned_fraction"] = Ratio(report.assigned, report.pixels);
  json["mean_absolute_error_kelvin"] = Ratio(report.sum_of_magnitudes_k, report.assigned);
  json["mean_error_kelvin"] = Ratio(report.sum_k, report.assigned);
  json["within_1_sigma"] = Ratio(report.within_68, report.with_sigma);
  json["within_1_96_sigma"] = Ratio(report.within_95, report.with_sigma);
  json["mean_error_over_sigma"] = Ratio(report.sum_of_ratios, report.with_sigma);
  return json;
}

}  // namespace isotherm
