#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "common/simulation/options.h"
#include "ground/experiment/experiment.h"
#include "ground/experiment/still_image.h"
#include "ground/thermal/scene_influence_corrector.h"

namespace isotherm {
namespace {

// As in the thesis: a calibrator's disc in front of a wall at room temperature, from 40 cm, behind
// a cardboard with a hole, and from where the disc is as large in the image as the hole was.
constexpr double kRoom_celsius = 23.0;
constexpr double kDisc_celsius[] = {5.0, 100.0};
constexpr double kDiscRadius_m = 0.076, kHoleRadius_m = 0.0335;
constexpr double kNear_m = 0.40, kFar_m = 0.85;

struct Setup {
  const char* name;
  double distance_m, radius_m;
};
constexpr Setup kSetups[] = {{"40 cm", kNear_m, kDiscRadius_m},
                             {"40 cm, behind a hole", kNear_m, kHoleRadius_m},
                             {"85 cm", kFar_m, kDiscRadius_m}};

/// Returns the scene influence of a PI 450, read from the thesis's figures 5.6 to 5.9.
SceneInfluence InfluenceOfPi450() {
  return {.near_fraction = 0.0387, .near_sigma_px = 40.0, .total_fraction = 0.0387};
}

/// Mean of the 5 x 5 pixels around the principal point.
double MiddleCelsius(const Image<float>& celsius) {
  constexpr int kReach = 2;
  const CameraModel camera = StillCamera();
  const int column = static_cast<int>(std::lround(camera.cx));
  const int row = static_cast<int>(std::lround(camera.cy));
  double sum = 0.0;
  for (int y = row - kReach; y <= row + kReach; ++y) {
    for (int x = column - kReach; x <= column + kReach; ++x)
      sum += static_cast<double>(celsius.At(x, y));
  }
  return sum / ((2 * kReach + 1) * (2 * kReach + 1));
}

struct Reading {
  double error_k = 0.0, expected_error_k = 0.0, corrected_error_k = 0.0;
};

Reading Measure(const Setup& setup, double disc_celsius, ThreadPool& pool) {
  const SceneInfluence influence = InfluenceOfPi450();
  SimulatedThermalOptions options = IdealThermalCamera({});
  SceneInfluenceOptions& simulated = *options.mutable_expert()->mutable_scene_influence();
  simulated.set_near_fraction(influence.near_fraction);
  simulated.set_near_sigma_px(influence.near_sigma_px);
  simulated.set_total_fraction(influence.total_fraction);
  FlatTarget target;
  target.distance_m = setup.distance_m;
  target.plate_celsius = kRoom_celsius;
  target.patch = FlatTarget::Patch::kDisc;
  target.patch_m = setup.radius_m;
  target.patch_celsius = disc_celsius;
  Image<float> celsius = TakeStill(MakeFlatTarget(target), options, pool);

  // What the rest of the image, and what the surroundings beyond the disc's rim, draw away.
  const CameraModel camera = StillCamera();
  const double radius_px = setup.radius_m / setup.distance_m * camera.fx;
  const double disc_fraction =
      std::numbers::pi * radius_px * radius_px / static_cast<double>(camera.width * camera.height);
  const double beyond = std::exp(-0.5 * std::pow(radius_px / influence.near_sigma_px, 2.0));
  const double away =
      influence.near_fraction * beyond + influence.total_fraction * (1.0 - disc_fraction);
  Reading reading;
  reading.expected_error_k = away * (kRoom_celsius - disc_celsius);
  reading.error_k = MiddleCelsius(celsius) - disc_celsius;
  SceneInfluenceCorrector(influence, celsius.width(), celsius.height()).Correct(celsius);
  reading.corrected_error_k = MiddleCelsius(celsius) - disc_celsius;
  return reading;
}

/// The largest of what the experiment is about, over both discs.
struct Extremes {
  double off_closed_form_k = 0.0, corrected_k = 0.0, uncorrected_k = 0.0;
  double same_radiation_k = 0.0;       ///< Between the hole and the disc from afar.
  double different_radiation_k = 0.0;  ///< Between the hole and the disc from as near.
};

void AddDisc(double disc_celsius, ThreadPool& pool, ExperimentReport& report, Extremes& extremes) {
  const auto raise = [](double& value, double to) { value = std::max(value, std::abs(to)); };
  double errors_k[std::size(kSetups)] = {};
  for (std::size_t i = 0; i < std::size(kSetups); ++i) {
    const Reading reading = Measure(kSetups[i], disc_celsius, pool);
    errors_k[i] = reading.error_k;
    report.table.rows.push_back(
        {fmt::format("disc of {:.0f} °C, {}", disc_celsius, kSetups[i].name),
         {reading.error_k, reading.expected_error_k, reading.corrected_error_k}});
    raise(extremes.off_closed_form_k, reading.error_k - reading.expected_error_k);
    raise(extremes.corrected_k, reading.corrected_error_k);
    raise(extremes.uncorrected_k, reading.error_k);
  }
  // Of the disc's contrast: that of 5 °C is small.
  const double per_100k = 100.0 / std::abs(disc_celsius - kRoom_celsius);
  raise(extremes.same_radiation_k, per_100k * (errors_k[2] - errors_k[1]));
  raise(extremes.different_radiation_k, per_100k * (errors_k[0] - errors_k[1]));
}

}  // namespace

Result<ExperimentReport> RunBackgroundExperiment(ThreadPool& pool) {
  ExperimentReport report;
  report.table.rows_are = "setup";
  report.table.columns = {"error as measured [K]", "by closed form [K]", "error corrected [K]"};
  Extremes extremes;
  for (const double celsius : kDisc_celsius) AddDisc(celsius, pool, report, extremes);
  const std::size_t setups = std::size(kSetups);
  const auto hole_error_k = [&](std::size_t disc) {
    const double plain_k = report.table.rows[disc * setups].values[0];
    return report.table.rows[disc * setups + 1].values[0] - plain_k;
  };
  const Requirement same = {"same radiation in the image: difference per 100 K of contrast",
                            extremes.same_radiation_k, Requirement::Sense::kAtMost, 0.3, "K"};
  const Requirement corrected = {"largest error, corrected", extremes.corrected_k,
                                 Requirement::Sense::kAtMost, 0.2, "K"};
  report.requirements = {
      {"largest error, off the closed form", extremes.off_closed_form_k,
       Requirement::Sense::kAtMost, 0.15, "K"},
      same,
      NegativeControl(same, "the same with and without the cardboard",
                      extremes.different_radiation_k),
      {"the cold disc's reading rises behind the hole by", hole_error_k(0),
       Requirement::Sense::kAtLeast, 0.1, "K"},
      {"the hot disc's reading falls behind the hole by", -hole_error_k(1),
       Requirement::Sense::kAtLeast, 0.5, "K"},
      corrected,
      NegativeControl(corrected, "largest error, as measured", extremes.uncorrected_k)};
  return report;
}

}  // namespace isotherm
