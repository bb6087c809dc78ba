#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "common/simulation/options.h"
#include "ground/experiment/experiment.h"
#include "ground/experiment/experiment_scan.h"
#include "ground/experiment/model_check.h"
#include "ground/experiment/pixel_response.h"
#include "ground/experiment/resolution_target.h"
#include "ground/experiment/still_image.h"
#include "ground/renderer/renderer.h"

namespace isotherm {
namespace {

// As in the thesis: a calibrator at 50 °C behind a cardboard with a square hole.
constexpr double kHole_m = 0.004, kHoleDistance_m = 0.30;
constexpr double kCalibrator_celsius = 50.0, kCardboard_celsius = 24.0;
constexpr std::array kFocus_m = {0.30, 0.35, 0.40, 0.60, 1.00};

// Per pixel and direction.
constexpr unsigned kStillRays = 16, kScanRays = 5;

// The scan: the lens is sharp where it begins, and the rig comes closer.
constexpr double kScanFocus_m = 0.60, kDuration_s = 4.0, kStill_s = 0.8;
constexpr std::array kBarWidths_m = {0.003, 0.0035, 0.004};

/// A lens that is focused at a distance, and does not blur otherwise.
void Focus(double focus_m, unsigned rays_per_pixel_side, SimulatedThermalOptions& thermal) {
  thermal.mutable_expert()->set_blur_px(0.0);
  thermal.mutable_expert()->set_rays_per_pixel_side(rays_per_pixel_side);
  thermal.mutable_expert()->mutable_lens()->set_focus_m(focus_m);
}

struct HoleReading {
  double circle_px = 0.0, celsius = 0.0, expected_celsius = 0.0;
};

/// The pixel at the middle of the hole, by a lens that is focused at this distance.
HoleReading ReadHole(double focus_m, ThreadPool& pool) {
  const CameraModel camera = StillCamera();
  SimulatedThermalOptions options = IdealThermalCamera({});
  Focus(focus_m, kStillRays, options);
  FlatTarget target;
  target.distance_m = kHoleDistance_m;
  target.plate_celsius = kCardboard_celsius;
  target.patch_celsius = kCalibrator_celsius;
  target.patch_m = 0.5 * kHole_m;
  const Eigen::Vector2d pixel(std::round(camera.cx), std::round(camera.cy));
  target.patch_middle_m = kHoleDistance_m * Unproject(camera, pixel);
  // Eq. (2.20b) solved for the circle of confusion, over the pixel's pitch by (2.19).
  const double f_m = 1e-3 * options.expert().lens().focal_length_mm();
  const double circle_m = f_m * f_m * std::abs(focus_m - kHoleDistance_m) /
                          (options.expert().lens().f_number() * (focus_m - f_m) * kHoleDistance_m);
  const double pitch_m = f_m * focus_m / (focus_m - f_m) / camera.fx;
  HoleReading reading;
  reading.circle_px = circle_m / pitch_m;
  reading.celsius =
      static_cast<double>(TakeStill(MakeFlatTarget(target), options, pool)
                              .At(static_cast<int>(pixel.x()), static_cast<int>(pixel.y())));
  const double half_px = 0.5 * kHole_m / kHoleDistance_m * camera.fx;
  reading.expected_celsius =
      MixedCelsius(BandRadiance(), target, SquareResponse(half_px, reading.circle_px));
  return reading;
}

void ReadHoles(ThreadPool& pool, ExperimentReport& report) {
  double off_k = 0.0, without_blur_k = 0.0, loss_in_focus_k = 0.0, loss_k = 0.0;
  for (const double focus_m : kFocus_m) {
    const HoleReading reading = ReadHole(focus_m, pool);
    report.table.rows.push_back(
        {fmt::format("hole at {:.2f} m, focus at {:.2f} m", kHoleDistance_m, focus_m),
         {reading.circle_px, reading.celsius, reading.expected_celsius, NAN, NAN}});
    off_k = std::max(off_k, std::abs(reading.celsius - reading.expected_celsius));
    without_blur_k = std::max(without_blur_k, std::abs(reading.celsius - kCalibrator_celsius));
    loss_k = kCalibrator_celsius - reading.celsius;
    if (focus_m == kHoleDistance_m) loss_in_focus_k = loss_k;
  }
  const Requirement equation = {"middle of the hole, off eq. (2.20)", off_k,
                                Requirement::Sense::kAtMost, 0.8, "K"};
  const Requirement in_focus = {"middle of the hole too cold, in focus", loss_in_focus_k,
                                Requirement::Sense::kAtMost, 0.3, "K"};
  report.requirements = {
      equation, NegativeControl(equation, "off what a lens without blur shows", without_blur_k),
      in_focus, NegativeControl(in_focus, "too cold, focused at 1 m", loss_k)};
}

GroundOptions FineModel() {
  GroundOptions options;
  options.mutable_volume()->set_voxel_size_m(0.0016);
  options.mutable_tsdf()->mutable_expert()->set_truncation_distance_m(0.008);
  ThermalOptions& thermal = *options.mutable_thermal();
  thermal.mutable_distance()->set_min_m(0.35);
  thermal.mutable_distance()->set_good_m(0.65);
  thermal.mutable_distance()->set_max_m(0.70);
  return options;
}

/// The same rig, but nobody knows how its lens is set.
Rig WithoutLens(Rig rig) {
  rig.thermal_sensor.lens.reset();
  return rig;
}

/// Contrast of each width of bars, and how much of them is covered.
struct ScanResult {
  std::vector<BarGroup> at_start, lens_known, lens_unknown;
};

Result<ScanResult> ScanBars(ThreadPool& pool, ExperimentReport& report) {
  SimulationOptions cameras = ExperimentCameras(kDuration_s, kScanFocus_m);
  cameras.mutable_thermal()->set_rate_hz(10.0);
  Focus(kScanFocus_m, kScanRays, *cameras.mutable_thermal());
  const auto scan = SimulatedScan::Create(
      cameras, MakeResolutionTarget(kBarWidths_m, FromTo(kScanFocus_m, 0.38, kDuration_s)));
  if (!scan) return Err(scan.error());
  GroundOptions options = FineModel();
  options.set_threads(pool.threads());
  const RigidTransform start = (*scan)->PoseAt((*scan)->depth_times().front().exposure);
  const auto known = GroundPipeline::Create(options, (*scan)->rig(), start);
  const auto unknown = GroundPipeline::Create(options, WithoutLens((*scan)->rig()), start);
  if (!known) return Err(known.error());
  if (!unknown) return Err(unknown.error());
  const CaptureTime still_until = (*scan)->depth_times().front().exposure + FromSeconds(kStill_s);
  ScanResult result;
  PlayScan(**scan, pool,
           {[&](const DepthFrame& frame) {
              (*known)->ProcessDepth(frame);
              (*unknown)->ProcessDepth(frame);
              if (result.at_start.empty() && frame.header.capture_time >= still_until)
                result.at_start = MeasureBars(**scan, (*unknown)->model(), kBarWidths_m, pool);
            },
            [&](const ThermalFramePtr& frame) {
              (*known)->ProcessThermal(frame);
              (*unknown)->ProcessThermal(frame);
            }});
  for (const auto* pipeline : {&*known, &*unknown}) {
    (*pipeline)->Finish();
    if (Status status = CheckTracked((*pipeline)->model()); !status.ok()) return Err(status);
    report.renderings.push_back(
        {pipeline == &*known ? "lens_known" : "lens_unknown",
         Renderer(FixedScale(23.0, kHotBar_celsius), ThermalOptions())
             .Thermal(LookAtModel((*pipeline)->model(), **scan,
                                  (*scan)->depth_times().front().exposure, pool))});
  }
  result.lens_known = MeasureBars(**scan, (*known)->model(), kBarWidths_m, pool);
  result.lens_unknown = MeasureBars(**scan, (*unknown)->model(), kBarWidths_m, pool);
  return result;
}

void DescribeScan(const ScanResult& result, ExperimentReport& report) {
  const auto min_of = [](double least, double value) {
    return std::isnan(value) ? value : std::min(least, value);
  };
  double kept = std::numeric_limits<double>::infinity(), kept_unknown = kept, coverage = 100.0;
  for (std::size_t i = 0; i < kBarWidths_m.size(); ++i) {
    const double start = result.at_start[i].contrast;
    const double with = 100.0 * result.lens_known[i].contrast / start;
    const double without = 100.0 * result.lens_unknown[i].contrast / start;
    kept = min_of(kept, with);
    kept_unknown = min_of(kept_unknown, without);
    coverage = min_of(coverage, result.lens_known[i].coverage_percent);
    report.table.rows.push_back(
        {fmt::format("bars of {:.1f} mm in the model, lens known", 1e3 * kBarWidths_m[i]),
         {NAN, NAN, NAN, with, result.lens_known[i].coverage_percent}});
    report.table.rows.push_back(
        {fmt::format("bars of {:.1f} mm in the model, lens not known", 1e3 * kBarWidths_m[i]),
         {NAN, NAN, NAN, without, result.lens_unknown[i].coverage_percent}});
  }
  const Requirement contrast = {"contrast kept of what was in focus, lens known", kept,
                                Requirement::Sense::kAtLeast, 95.0, "%"};
  report.requirements.push_back(contrast);
  report.requirements.push_back(
      NegativeControl(contrast, "contrast kept, lens not known", kept_unknown));
  report.requirements.push_back({"points of the bars with a temperature, lens known", coverage,
                                 Requirement::Sense::kAtLeast, 80.0, "%"});
}

}  // namespace

Result<ExperimentReport> RunFocusExperiment(ThreadPool& pool) {
  ExperimentReport report;
  report.table.rows_are = "lens";
  report.table.columns = {"circle [px]", "middle of the hole [°C]", "by eq. (2.20) [°C]",
                          "contrast kept [%]", "coverage [%]"};
  ReadHoles(pool, report);
  const Result<ScanResult> result = ScanBars(pool, report);
  if (!result) return Err(result.error());
  DescribeScan(*result, report);
  return report;
}

}  // namespace isotherm
