#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "common/base/units.h"
#include "common/simulation/scene_builder.h"
#include "ground/experiment/experiment.h"
#include "ground/experiment/experiment_scan.h"
#include "ground/experiment/model_check.h"
#include "ground/renderer/renderer.h"

namespace isotherm {
namespace {

// The rig goes round the disc up to kLastAngle_deg; returns become rare from 70 degrees on.
constexpr double kDuration_s = 5.0, kDistance_m = 0.50;
constexpr double kLastAngle_deg = 75.0;
constexpr double kDisc_celsius = 100.0, kSurround_celsius = 23.0;
constexpr double kDiscEmissivity = 0.95, kDiscIndex = 1.5;  // Paint.
constexpr double kDiscRadius = 0.076;
const Eigen::Vector3d kDisc(0.48, 0.52, 0.50);  ///< Middle of the calibrator's disc.

/// A calibrator's disc of one temperature in its panel, on a table in a corner.
StagedScene Calibrator() {
  SceneBuilder scene(kSurround_celsius);
  scene.UseMaterial({0.96, kDiscIndex, 0.0, false});
  scene.Box("wall", {0.02, 0.02, 0.84}, {0.94, 0.94, 0.90}).temperature = Uniform(24.0);
  scene.Box("side wall", {0.02, 0.02, 0.10}, {0.08, 0.94, 0.84}).temperature = Uniform(24.0);
  scene.Box("table", {0.08, 0.70, 0.10}, {0.94, 0.76, 0.84}).temperature = Uniform(24.0);
  scene.RotatedBox("carton", {0.20, 0.62, 0.62}, {0.14, 0.16, 0.14}, {0, 30, 0}).temperature =
      Uniform(24.0);
  scene.Box("housing", {0.36, 0.36, kDisc.z()}, {0.60, 0.70, 0.68}).temperature = Uniform(36.0);
  scene.Sphere("knob", {0.57, 0.40, kDisc.z()}, 0.015).temperature = Uniform(34.0);
  const Eigen::Vector3d forward(0.0, 0.0, -1.0);
  scene.Tube("rim", kDisc + 0.014 * forward, kDisc, kDiscRadius + 0.012, kDiscRadius).temperature =
      Uniform(55.0);
  scene.UseMaterial({kDiscEmissivity, kDiscIndex, 0.0, false});
  scene.Cylinder("disc", kDisc + 0.006 * forward, kDisc, kDiscRadius).temperature =
      Uniform(kDisc_celsius);
  ScanPath path;
  path.target_x_m = {kDisc.x()};
  path.target_y_m = {kDisc.y()};
  path.target_z_m = {kDisc.z()};
  path.azimuth_rad = FromTo(0.0, kLastAngle_deg * kRadPerDeg, kDuration_s - 0.4);
  path.distance_m = {kDistance_m};
  return {scene.Build("calibrator in a corner"), path, {}};
}

GroundOptions WithAngleLimits(bool validation) {
  GroundOptions options;
  // The simulated depth camera has no shutter of rows: faster motion is good enough here.
  options.mutable_tsdf()->mutable_expert()->set_max_step_m(0.03);
  options.mutable_tsdf()->mutable_expert()->set_max_step_deg(3.0);
  ThermalOptions& thermal = *options.mutable_thermal();
  // The rim stands 8 mm above the disc: less than what counts as hiding by default.
  thermal.mutable_expert()->mutable_occlusion()->set_parallax_tolerance_m(0.004);
  // The experiment asks for this accuracy.
  thermal.mutable_expert()->set_max_gradient_error_k(1.0);
  // As in the thesis.
  thermal.mutable_angle()->set_min_deg(15.0);
  thermal.mutable_angle()->set_good_deg(30.0);
  thermal.mutable_angle()->set_max_deg(45.0);
  thermal.mutable_expert()->set_validation(validation);
  thermal.mutable_expert()->set_keep_bad(!validation);
  return options;
}

struct DiscErrors {
  double mean_kelvin = 0.0;
  double largest_kelvin = 0.0;
  std::size_t points = 0;      ///< Points of the disc with a temperature.
  std::size_t all_points = 0;  ///< Points of the disc.
  ErrorSummary apparent;       ///< Errors of their apparent temperatures.
};

/// Errors of the disc's temperature, found from the apparent one with the emissivity at right
/// angles.
DiscErrors MeasureDisc(const PlayedScan& played, const ScanModel& model, ThreadPool& pool) {
  // Nearer to its border, a thermal pixel and its blur receive radiation from the rim as well.
  constexpr double kBorder_m = 0.004;
  const SimulatedScan& scan = *played.scan;
  DiscErrors errors;
  std::vector<CheckedPoint> disc;
  for (const CheckedPoint& point :
       CheckModel(scan.scene(), scan.band(), model.tsdf(), model.thermal(), pool)) {
    if (scan.scene().primitives()[static_cast<std::size_t>(point.truth.primitive)].name != "disc")
      continue;
    const Eigen::Vector3d offset = point.truth.p_world - kDisc;
    if (std::hypot(offset.x(), offset.y()) > kDiscRadius - kBorder_m) continue;
    ++errors.all_points;
    disc.push_back(point);
    if (!point.measured()) continue;
    const auto celsius =
        TrueCelsius(scan.band(), point.point.celsius, kDiscEmissivity, kSurround_celsius);
    if (!celsius) continue;
    errors.mean_kelvin += *celsius - kDisc_celsius;
    errors.largest_kelvin = std::max(errors.largest_kelvin, std::abs(*celsius - kDisc_celsius));
    ++errors.points;
  }
  errors.mean_kelvin /= static_cast<double>(std::max<std::size_t>(1, errors.points));
  errors.apparent = SummarizeErrors(disc);
  return errors;
}

/// Reflectivity of a dielectric for unpolarised radiation (Fresnel).
double DielectricReflectivity(double angle_rad, double n) {
  const double cos_out = std::cos(angle_rad);
  const double cos_in = std::sqrt(1.0 - std::pow(std::sin(angle_rad) / n, 2));
  const double s = (cos_out - n * cos_in) / (cos_out + n * cos_in);
  const double p = (cos_in - n * cos_out) / (cos_in + n * cos_out);
  return 0.5 * (s * s + p * p);
}

/// The same sweep with cameras that show the disc's radiation and nothing else, not even images
/// that a shutter event froze.
Result<std::unique_ptr<SimulatedScan>> IdealScan() {
  SimulationOptions cameras;
  cameras.set_duration_s(kDuration_s);
  cameras.set_ideal_cameras(true);
  cameras.mutable_shutter()->set_interval_s(0.0);
  return SimulatedScan::Create(cameras, Calibrator());
}

/// Largest difference between the emissivity that simulated thermal images of the disc show and
/// Fresnel's, over the sweep.
double CompareWithFresnel(const SimulatedScan& scan) {
  SimulatedScan::Scratch scratch;
  double largest = 0.0;
  const double hot = scan.band().RadianceFromCelsius(kDisc_celsius);
  const double surround = scan.band().RadianceFromCelsius(kSurround_celsius);
  const Eigen::Vector3d front = kDisc - Eigen::Vector3d(0.0, 0.0, 0.006);
  for (std::size_t number = 0; number < scan.thermal_times().size(); number += 10) {
    const RigidTransform T_world_thermal =
        scan.ThermalPoseAt(scan.thermal_times()[number].exposure);
    const auto pixel = Project(*scan.rig().thermal, T_world_thermal.inverse() * front);
    if (!pixel) continue;
    const int x = static_cast<int>(std::lround(pixel->x()));
    const int y = static_cast<int>(std::lround(pixel->y()));
    const RawFrame frame = scan.RenderThermal(number, scratch);
    const double measured =
        scan.band().RadianceFromCelsius(frame.thermal_scale.Celsius(frame.pixels.At(x, y)));
    const Eigen::Vector3d to_camera = (T_world_thermal.translation() - front).normalized();
    const double reflectivity = DielectricReflectivity(std::acos(-to_camera.z()), kDiscIndex);
    const double fresnel =
        kDiscEmissivity * (1.0 - reflectivity) / (1.0 - DielectricReflectivity(0.0, kDiscIndex));
    largest = std::max(largest, std::abs((measured - surround) / (hot - surround) - fresnel));
  }
  return largest;
}

}  // namespace

Result<ExperimentReport> RunAngleExperiment(ThreadPool& pool) {
  const auto played = Play(ExperimentCameras(kDuration_s, kDistance_m), Calibrator(),
                           {WithAngleLimits(false), WithAngleLimits(true)}, pool);
  if (!played) return Err(played.error());
  const auto ideal = IdealScan();
  if (!ideal) return Err(ideal.error());
  ExperimentReport report;
  report.table.rows_are = "method";
  report.table.columns = {"points on the disc", "mean error [K]",   "largest error [K]",
                          "coverage [%]",       "within sigma [%]", "within 1.96 sigma [%]"};
  const Renderer renderer(FixedScale(kSurround_celsius, kDisc_celsius), ThermalOptions());
  const CaptureTime middle = played->scan->depth_times()[played->scan->depth_times().size() / 2]
                                 .exposure;  // At about 40 degrees, as in the thesis.
  constexpr const char* kLabels[] = {"not validated", "validated"};
  constexpr const char* kRenderings[] = {"not_validated", "validated"};
  for (std::size_t i = 0; i < 2; ++i) {
    const ScanModel model = played->pipelines[i]->model();
    const DiscErrors errors = MeasureDisc(*played, model, pool);
    report.table.rows.push_back(
        {kLabels[i],
         {static_cast<double>(errors.points), errors.mean_kelvin, errors.largest_kelvin,
          Percent(errors.points, errors.all_points), errors.apparent.within_sigma_percent,
          errors.apparent.within_1_96_sigma_percent}});
    report.renderings.push_back(
        {kRenderings[i], renderer.Thermal(LookAtModel(model, *played->scan, middle, pool))});
  }
  // Noise of single pixels (0.04 K) is 0.0006 of the difference in radiance.
  const Requirement error = {"largest error of the disc, validated", report.table.rows[1].values[2],
                             Requirement::Sense::kAtMost, 1.0, "K"};
  report.requirements = {error,
                         NegativeControl(error, "largest error of the disc, not validated",
                                         report.table.rows[0].values[2]),
                         {"points of the disc with a temperature", report.table.rows[1].values[0],
                          Requirement::Sense::kAtLeast, 3000.0, ""},
                         {"simulated emissivity off Fresnel's", CompareWithFresnel(**ideal),
                          Requirement::Sense::kAtMost, 0.003, ""}};
  return report;
}

}  // namespace isotherm
