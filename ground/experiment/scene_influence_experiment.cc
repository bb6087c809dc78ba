#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "common/base/units.h"
#include "common/simulation/scene_builder.h"
#include "ground/experiment/experiment.h"
#include "ground/experiment/experiment_scan.h"
#include "ground/experiment/model_check.h"
#include "ground/renderer/renderer.h"
#include "ground/thermal/scene_influence_corrector.h"

namespace isotherm {
namespace {

// As in the thesis: holes of a cardboard at room temperature in front of a calibrator, 22 cm away.
constexpr double kRadii_m[] = {0.010, 0.020, 0.030, 0.045, 0.070};
constexpr double kDistance_m = 0.22, kScanDistance_m = 0.50;
constexpr double kDisc_celsius = 120.0, kCardboard_celsius = 24.0;
constexpr double kEmissivity = 0.95, kIndex = 1.5;
constexpr double kDuration_s = 5.0;
const Eigen::Vector3d kMiddle(0.48, 0.48, 0.50);

/// Sets the scene influence of a PI 450, read from the thesis's figures 5.6 to 5.9.
void SetInfluence(SimulationOptions& cameras) {
  SceneInfluenceOptions& influence =
      *cameras.mutable_thermal()->mutable_expert()->mutable_scene_influence();
  influence.set_near_fraction(0.0387);
  influence.set_near_sigma_px(40.0);
  influence.set_total_fraction(0.0387);
}

StagedScene DiscBeforeCardboard(double radius_m, double distance_m) {
  SceneBuilder scene(kCardboard_celsius);
  scene.UseMaterial({kEmissivity, kIndex, 0.0, false});
  scene.Box("cardboard", {0.0, 0.0, kMiddle.z()}, {0.96, 0.96, kMiddle.z() + 0.01}).temperature =
      Uniform(kCardboard_celsius);
  // Shape for the tracker, at the cardboard's temperature.
  scene.RotatedBox("carton", {0.26, 0.62, kMiddle.z() - 0.03}, {0.10, 0.12, 0.08}, {0, 30, 10})
      .temperature = Uniform(kCardboard_celsius);
  scene.RotatedBox("book", {0.66, 0.33, kMiddle.z() - 0.02}, {0.14, 0.06, 0.06}, {20, 0, 25})
      .temperature = Uniform(kCardboard_celsius);
  scene.Sphere("ball", {0.70, 0.66, kMiddle.z() - 0.02}, 0.04).temperature =
      Uniform(kCardboard_celsius);
  scene.Cylinder("disc", kMiddle - Eigen::Vector3d(0.0, 0.0, 0.001), kMiddle, radius_m)
      .temperature = Uniform(kDisc_celsius);
  ScanPath path;
  path.target_x_m = {kMiddle.x()};
  path.target_y_m = {kMiddle.y()};
  path.target_z_m = {kMiddle.z()};
  path.distance_m = {distance_m};
  return {scene.Build("disc in a cardboard"), path, {}};
}

Image<float> ToCelsius(const RawFrame& frame) {
  Image<float> celsius(frame.pixels.width(), frame.pixels.height());
  for (std::size_t i = 0; i < celsius.size(); ++i)
    celsius.pixels()[i] = frame.thermal_scale.Celsius(frame.pixels.pixels()[i]);
  return celsius;
}

/// Mean of the 5 x 5 pixels around the middle of the disc.
double MiddleCelsius(const SimulatedScan& scan, const Image<float>& celsius) {
  constexpr int kReach = 2;
  const CaptureTime time = scan.thermal_times().front().exposure;
  const auto pixel =
      Project(*scan.rig().thermal, scan.ThermalPoseAt(time).inverse() * kMiddle).value();
  const int column = static_cast<int>(std::lround(pixel.x()));
  const int row = static_cast<int>(std::lround(pixel.y()));
  double sum = 0.0;
  for (int y = row - kReach; y <= row + kReach; ++y) {
    for (int x = column - kReach; x <= column + kReach; ++x)
      sum += static_cast<double>(celsius.At(x, y));
  }
  return sum / ((2 * kReach + 1) * (2 * kReach + 1));
}

struct HoleErrors {
  double radius_px, measured_k, corrected_k;
};

/// Measures how far the middle of the disc is off, against the same image of a camera without
/// influence.
Result<HoleErrors> MeasureHole(double radius_m) {
  SimulationOptions cameras = ExperimentCameras(1.0, kDistance_m);
  cameras.mutable_thermal()->mutable_expert()->mutable_scene_influence()->set_near_fraction(0.0);
  cameras.mutable_thermal()->mutable_expert()->mutable_scene_influence()->set_total_fraction(0.0);
  const auto clean = SimulatedScan::Create(cameras, DiscBeforeCardboard(radius_m, kDistance_m));
  if (!clean) return Err(clean.error());
  SetInfluence(cameras);
  const auto scan = SimulatedScan::Create(cameras, DiscBeforeCardboard(radius_m, kDistance_m));
  if (!scan) return Err(scan.error());
  SimulatedScan::Scratch scratch;
  const double own_celsius = MiddleCelsius(**clean, ToCelsius((*clean)->RenderThermal(0, scratch)));
  const Image<float> measured = ToCelsius((*scan)->RenderThermal(0, scratch));
  Image<float> corrected = measured;
  SceneInfluenceCorrector((*scan)->rig().thermal_sensor.scene_influence, measured.width(),
                          measured.height())
      .Correct(corrected);
  return HoleErrors{radius_m * (*scan)->rig().thermal->fx / kDistance_m,
                    MiddleCelsius(**scan, measured) - own_celsius,
                    MiddleCelsius(**scan, corrected) - own_celsius};
}

StagedScene ScanOfDisc() {
  StagedScene staged = DiscBeforeCardboard(kRadii_m[2], kScanDistance_m);
  staged.path.azimuth_rad = FromTo(-20.0 * kRadPerDeg, 20.0 * kRadPerDeg, kDuration_s - 0.4);
  staged.path.elevation_rad = FromTo(-8.0 * kRadPerDeg, 8.0 * kRadPerDeg, kDuration_s - 0.4);
  return staged;
}

GroundOptions WithCorrection(bool correct) {
  GroundOptions options;
  options.mutable_tsdf()->mutable_expert()->set_max_step_m(0.03);
  options.mutable_tsdf()->mutable_expert()->set_max_step_deg(3.0);
  options.mutable_thermal()->mutable_expert()->set_correct_scene_influence(correct);
  return options;
}

/// Median absolute error of the disc's points, away from its border.
ErrorSummary MeasureDisc(const PlayedScan& played, const ScanModel& model, ThreadPool& pool) {
  // Nearer the border the camera's blur mixes in the panel.
  constexpr double kBorder_m = 0.005;
  const SimulatedScan& scan = *played.scan;
  std::vector<CheckedPoint> points =
      CheckModel(scan.scene(), scan.band(), model.tsdf(), model.thermal(), pool);
  std::erase_if(points, [&](const CheckedPoint& point) {
    const Eigen::Vector3d offset = point.truth.p_world - kMiddle;
    return scan.scene().primitives()[static_cast<std::size_t>(point.truth.primitive)].name !=
               "disc" ||
           std::hypot(offset.x(), offset.y()) > kRadii_m[2] - kBorder_m;
  });
  return SummarizeErrors(points);
}

}  // namespace

Result<ExperimentReport> RunSceneInfluenceExperiment(ThreadPool& pool) {
  ExperimentReport report;
  report.table.rows_are = "hole";
  report.table.columns = {"radius [px]", "error as measured [K]", "error corrected [K]"};
  double largest_corrected_k = 0.0;
  std::vector<double> measured_k;
  for (const double radius_m : kRadii_m) {
    const Result<HoleErrors> hole = MeasureHole(radius_m);
    if (!hole) return Err(hole.error());
    report.table.rows.push_back({fmt::format("{:.0f} mm", 1e3 * radius_m),
                                 {hole->radius_px, hole->measured_k, hole->corrected_k}});
    measured_k.push_back(hole->measured_k);
    if (!(std::abs(hole->corrected_k) <= largest_corrected_k))  // NaN is not met.
      largest_corrected_k = std::abs(hole->corrected_k);
  }
  SimulationOptions cameras = ExperimentCameras(kDuration_s, kScanDistance_m);
  SetInfluence(cameras);
  const auto played =
      Play(cameras, ScanOfDisc(), {WithCorrection(false), WithCorrection(true)}, pool);
  if (!played) return Err(played.error());
  double model_k[2] = {};
  const Renderer renderer(FixedScale(kCardboard_celsius, kDisc_celsius), ThermalOptions());
  for (std::size_t i = 0; i < 2; ++i) {
    const ScanModel model = played->pipelines[i]->model();
    if (Status tracked = CheckTracked(model); !tracked.ok()) return Err(tracked);
    model_k[i] = MeasureDisc(*played, model, pool).median_k;
    report.renderings.push_back(
        {i == 0 ? "as_measured" : "corrected",
         renderer.Thermal(LookAtModel(model, *played->scan,
                                      played->scan->depth_times().front().exposure, pool))});
  }
  report.table.rows.push_back({"disc of 30 mm in the model", {NAN, model_k[0], model_k[1]}});
  const bool falls_with_size = std::ranges::is_sorted(measured_k);
  const Requirement holes = {"largest error of a hole, corrected", largest_corrected_k,
                             Requirement::Sense::kAtMost, 0.2, "K"};
  const Requirement disc = {"median error of the disc in the model, corrected", model_k[1],
                            Requirement::Sense::kAtMost, 0.3, "K"};
  report.requirements = {
      holes,
      NegativeControl(holes, "error of the smallest hole, as measured", -measured_k.front()),
      {"smallest hole, too cold as measured", -measured_k.front(), Requirement::Sense::kAtLeast,
       5.0, "K"},
      {"larger holes are less off (1 = yes)", falls_with_size ? 1.0 : 0.0,
       Requirement::Sense::kAtLeast, 1.0, ""},
      disc,
      NegativeControl(disc, "median error of the disc in the model, not corrected", model_k[0])};
  return report;
}

}  // namespace isotherm
