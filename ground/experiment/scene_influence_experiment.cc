#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "common/base/units.h"
#include "common/simulation/scene_builder.h"
#include "ground/experiment/experiment.h"
#include "ground/experiment/experiment_scan.h"
#include "ground/experiment/model_check.h"
#include "ground/radiometric_calibration/influence_fit.h"
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

/// An image of a hole, and what a camera without influence shows of the disc behind it.
struct HoleImage {
  double radius_px = 0.0;
  int column = 0, row = 0;  ///< The disc's middle.
  double own_celsius = 0.0;
  Image<float> celsius;
  SceneInfluence influence;  ///< The camera's.
};

/// Mean of the 5 x 5 pixels around the middle of the disc.
double MiddleCelsius(const HoleImage& hole, const Image<float>& celsius) {
  constexpr int kReach = 2;
  double sum = 0.0;
  for (int y = hole.row - kReach; y <= hole.row + kReach; ++y) {
    for (int x = hole.column - kReach; x <= hole.column + kReach; ++x)
      sum += static_cast<double>(celsius.At(x, y));
  }
  return sum / ((2 * kReach + 1) * (2 * kReach + 1));
}

Result<HoleImage> LookThroughHole(double radius_m) {
  SimulationOptions cameras = ExperimentCameras(1.0, kDistance_m);
  cameras.mutable_thermal()->mutable_expert()->mutable_scene_influence()->set_near_fraction(0.0);
  cameras.mutable_thermal()->mutable_expert()->mutable_scene_influence()->set_total_fraction(0.0);
  const auto clean = SimulatedScan::Create(cameras, DiscBeforeCardboard(radius_m, kDistance_m));
  if (!clean) return Err(clean.error());
  SetInfluence(cameras);
  const auto scan = SimulatedScan::Create(cameras, DiscBeforeCardboard(radius_m, kDistance_m));
  if (!scan) return Err(scan.error());
  SimulatedScan::Scratch scratch;
  const CameraModel& camera = *(*scan)->rig().thermal;
  const CaptureTime time = (*scan)->thermal_times().front().exposure;
  const auto pixel = Project(camera, (*scan)->ThermalPoseAt(time).inverse() * kMiddle).value();
  HoleImage hole{.radius_px = radius_m * camera.fx / kDistance_m,
                 .column = static_cast<int>(std::lround(pixel.x())),
                 .row = static_cast<int>(std::lround(pixel.y())),
                 .celsius = ToCelsius((*scan)->RenderThermal(0, scratch)),
                 .influence = (*scan)->rig().thermal_sensor.scene_influence};
  hole.own_celsius = MiddleCelsius(hole, ToCelsius((*clean)->RenderThermal(0, scratch)));
  return hole;
}

/// How far the middle of the disc is off once `influence` is taken out, kelvin.
double ErrorWithout(const SceneInfluence& influence, const HoleImage& hole) {
  Image<float> corrected = hole.celsius;
  SceneInfluenceCorrector(influence, corrected.width(), corrected.height()).Correct(corrected);
  return MiddleCelsius(hole, corrected) - hole.own_celsius;
}

/// Finds what `isotherm calibrate radiometric` finds in the images.
Result<SceneInfluence> Calibrate(const std::vector<HoleImage>& holes) {
  std::vector<ApertureView> views;
  for (const HoleImage& hole : holes) {
    Result<ApertureImage> image = FindAperture(hole.celsius, kDisc_celsius);
    if (!image) return Err(image.error());
    views.push_back({std::move(*image), 0});
  }
  const Result<InfluenceReport> found = FitInfluence(views);
  if (!found) return Err(found.error());
  return found->influence;
}

/// Rows of holes, and the largest errors of the middle of the disc.
struct HoleErrors {
  std::vector<double> measured_k;  ///< By hole, signed.
  double largest_corrected_k = 0.0, largest_calibrated_k = 0.0;
};

Result<HoleErrors> MeasureHoles(ExperimentTable& table) {
  std::vector<HoleImage> holes;
  for (const double radius_m : kRadii_m) {
    Result<HoleImage> hole = LookThroughHole(radius_m);
    if (!hole) return Err(hole.error());
    holes.push_back(std::move(*hole));
  }
  const Result<SceneInfluence> calibrated = Calibrate(holes);
  if (!calibrated) return Err(calibrated.error());
  HoleErrors errors;
  const auto keep_largest = [](double error_k, double& largest_k) {
    if (!(std::abs(error_k) <= largest_k)) largest_k = std::abs(error_k);  // NaN is not met.
  };
  for (std::size_t i = 0; i < holes.size(); ++i) {
    const HoleImage& hole = holes[i];
    const double measured_k = MiddleCelsius(hole, hole.celsius) - hole.own_celsius;
    const double corrected_k = ErrorWithout(hole.influence, hole);
    const double calibrated_k = ErrorWithout(*calibrated, hole);
    table.rows.push_back({fmt::format("{:.0f} mm", 1e3 * kRadii_m[i]),
                          {hole.radius_px, measured_k, corrected_k, calibrated_k}});
    errors.measured_k.push_back(measured_k);
    keep_largest(corrected_k, errors.largest_corrected_k);
    keep_largest(calibrated_k, errors.largest_calibrated_k);
  }
  return errors;
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
  report.table.columns = {"radius [px]", "error as measured [K]", "error corrected [K]",
                          "error corrected as calibrated [K]"};
  const Result<HoleErrors> errors = MeasureHoles(report.table);
  if (!errors) return Err(errors.error());
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
  report.table.rows.push_back({"disc of 30 mm in the model", {NAN, model_k[0], model_k[1], NAN}});
  const bool falls_with_size = std::ranges::is_sorted(errors->measured_k);
  const Requirement holes = {"largest error of a hole, corrected", errors->largest_corrected_k,
                             Requirement::Sense::kAtMost, 0.2, "K"};
  const Requirement calibrated = {"largest error of a hole, corrected as its images calibrate it",
                                  errors->largest_calibrated_k, Requirement::Sense::kAtMost, 0.7,
                                  "K"};
  const Requirement disc = {"median error of the disc in the model, corrected", model_k[1],
                            Requirement::Sense::kAtMost, 0.3, "K"};
  report.requirements = {
      holes,
      NegativeControl(holes, "error of the smallest hole, as measured",
                      -errors->measured_k.front()),
      calibrated,
      {"smallest hole, too cold as measured", -errors->measured_k.front(),
       Requirement::Sense::kAtLeast, 5.0, "K"},
      {"larger holes are less off (1 = yes)", falls_with_size ? 1.0 : 0.0,
       Requirement::Sense::kAtLeast, 1.0, ""},
      disc,
      NegativeControl(disc, "median error of the disc in the model, not corrected", model_k[0])};
  return report;
}

}  // namespace isotherm
