#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <numbers>
#include <optional>
#include <vector>

#include "common/base/units.h"
#include "common/geometry/rigid_transform.h"
#include "ground/experiment/bar_wall.h"
#include "ground/experiment/experiment.h"
#include "ground/experiment/experiment_scan.h"
#include "ground/experiment/model_check.h"

namespace isotherm {
namespace {

// Appendix F: a rig at thesis speed, and a point a metre away.
constexpr double kSpeed_m_s = 0.3, kRotation_rad_s = 18.0 * kRadPerDeg;
constexpr double kFrame_s = 1.0 / 30.0, kPoint_m = 1.0;
constexpr double kTimeError_s = 0.006;
constexpr double kPoseErrorRatio =
    0.10;  ///< Error of the pose, as a fraction of the motion between two frames.

// The scan: bars that the rig passes at nearly constant speed.
constexpr double kDuration_s = 3.0, kPassing_s = 1.2;

/// The rig after so much of the time between two frames that are both true.
using PoseAt = RigidTransform (*)(double seconds);

RigidTransform Moving(double seconds) {
  return MakeTransform({kSpeed_m_s * seconds, 0.0, 0.0}, Eigen::Quaterniond::Identity());
}

RigidTransform Turning(double seconds) {
  return MakeTransform(
      Eigen::Vector3d::Zero(),
      Eigen::Quaterniond(Eigen::AngleAxisd(kRotation_rad_s * seconds, Eigen::Vector3d::UnitY())));
}

/// How far the point in the middle of the image is put off if the pose is interpolated at
/// `wrong_s` instead of `right_s`, between frames at 0 and kFrame_s of which the later is by
/// `pose_error` of their distance too far.
double OffsetOfPoint(PoseAt pose, double right_s, double wrong_s, double pose_error) {
  const RigidTransform interpolated =
      Interpolate(pose(0.0), pose((1.0 + pose_error) * kFrame_s), wrong_s / kFrame_s);
  const Eigen::Vector3d p_camera(0.0, 0.0, kPoint_m);
  return (interpolated * p_camera - pose(right_s) * p_camera).norm();
}

/// On an arc around the object, halfway between two frames: how far linear interpolation is off.
double ArcOffset(double radius_m, double speed_m_s) {
  const auto pose = [&](double angle_rad) {
    const Eigen::AngleAxisd rotation(angle_rad, Eigen::Vector3d::UnitY());
    return MakeTransform(rotation * Eigen::Vector3d(0.0, 0.0, -radius_m),
                         Eigen::Quaterniond(rotation));
  };
  const double angle_rad = 2.0 * std::asin(0.5 * speed_m_s * kFrame_s / radius_m);
  return TranslationDistance(Interpolate(pose(0.0), pose(angle_rad), 0.5), pose(0.5 * angle_rad));
}

struct Analysis {
  double off_thesis_mm = 0.0;
  double arc_mm = 0.0;  ///< The largest error of linear interpolation at thesis speed.
  double time_error_mm = 0.0;
};

Analysis Analyse(ExperimentReport& report) {
  Analysis analysis;
  const auto add = [&](const std::string& what, double offset_m, double thesis_mm) {
    report.table.rows.push_back({what, {kMmPerM * offset_m, thesis_mm, NAN}});
    analysis.off_thesis_mm =
        std::max(analysis.off_thesis_mm, std::abs(kMmPerM * offset_m - thesis_mm));
  };
  for (const auto& [radius_m, speed_m_s, thesis_mm] :
       {std::tuple(1.0, 0.3, 0.01), std::tuple(0.5, 0.3, 0.02), std::tuple(1.0, 0.6, 0.05)}) {
    const double offset_m = ArcOffset(radius_m, speed_m_s);
    add(fmt::format("interpolation on an arc of {:.1f} m, {:.1f} m/s", radius_m, speed_m_s),
        offset_m, thesis_mm);
    if (speed_m_s == kSpeed_m_s) analysis.arc_mm = std::max(analysis.arc_mm, kMmPerM * offset_m);
  }
  // In the middle between two frames interpolation is worst.
  constexpr double kRight_s = 0.5 * kFrame_s;
  const double moved_m = OffsetOfPoint(&Moving, kRight_s, kRight_s + kTimeError_s, 0.0);
  const double turned_m = OffsetOfPoint(&Turning, kRight_s, kRight_s + kTimeError_s, 0.0);
  add("time 6 ms late, 0.3 m/s", moved_m, 1.8);
  add("time 6 ms late, 18 degrees/s", turned_m, 1.9);
  add("time 6 ms late, both", moved_m + turned_m, 3.7);
  add("pose 10 % off, 0.3 m/s", OffsetOfPoint(&Moving, kFrame_s, kFrame_s, kPoseErrorRatio), 1.0);
  add("pose 10 % off, 18 degrees/s", OffsetOfPoint(&Turning, kFrame_s, kFrame_s, kPoseErrorRatio),
      1.0);
  analysis.time_error_mm = kMmPerM * moved_m;
  return analysis;
}

StagedScene PassAlongBars() {
  SceneBuilder scene = BarWall::Make();
  ScanPath path;
  // A small part of a wide swing.
  constexpr double kAmplitude_m = 1.5;
  path.target_x_m = {0.48, kAmplitude_m, 2.0 * std::numbers::pi * kAmplitude_m / kSpeed_m_s,
                     -0.5 * kSpeed_m_s * (kDuration_s - 0.8) / kAmplitude_m};
  path.target_y_m = {0.52};
  path.target_z_m = {BarWall::kWall_m};
  path.distance_m = {0.55};
  return {scene.Build("pass along bars"), path, {}};
}

GroundOptions Believing() {
  // No rig moves so fast: smear leaves nothing out.
  constexpr double kAnySmear_px = 1e6;
  GroundOptions options;
  // The simulated cameras have no inertia: motion harms by its timing alone.
  ThermalMotionOptions& motion = *options.mutable_thermal()->mutable_expert()->mutable_motion();
  motion.set_smear_good_px(kAnySmear_px);
  motion.set_smear_max_px(kAnySmear_px);
  options.mutable_tsdf()->mutable_expert()->set_max_step_m(0.04);
  return options;
}

/// Where the temperature passes the middle between hot and cold, between the nearest points with a
/// temperature on either side of a true edge; mean over rising and falling edges of what each is
/// off to the right.
double EdgeOffset(const std::map<int, std::pair<double, int>>& celsius_by_bin, double bin_m) {
  std::vector<std::pair<double, double>> profile;
  for (const auto& [bin, sum] : celsius_by_bin)
    profile.emplace_back((bin + 0.5) * bin_m, sum.first / sum.second);
  constexpr double kMiddle_celsius = 0.5 * (BarWall::kHot_celsius + BarWall::kCold_celsius);
  double sums_m[2] = {};
  int counts[2] = {};
  for (std::size_t i = 0; i + 1 < profile.size(); ++i) {
    const auto& [x, celsius] = profile[i];
    const auto& [next_x, next_celsius] = profile[i + 1];
    if ((celsius - kMiddle_celsius) * (next_celsius - kMiddle_celsius) > 0.0) continue;
    const double crossing =
        std::lerp(x, next_x, (kMiddle_celsius - celsius) / (next_celsius - celsius));
    const double bars = (crossing - BarWall::kFirst_m) / BarWall::kBar_m;
    const int rising = next_celsius > celsius ? 1 : 0;
    sums_m[rising] += (bars - std::round(bars)) * BarWall::kBar_m;
    ++counts[rising];
  }
  // Rising and falling edges are blurred to opposite sides; only their mean is free of it.
  if (counts[0] == 0 || counts[1] == 0) return std::nan("");
  return 0.5 * (sums_m[0] / counts[0] + sums_m[1] / counts[1]);
}

/// How far the temperatures of the bars that were passed at full speed are put to the right.
double MeasureOffset(const SimulatedScan& scan, const ScanModel& model, ThreadPool& pool) {
  // Half a voxel. The region lies where the rig passes at full speed, away from the bars' ends.
  constexpr double kBin_m = 0.001;
  constexpr double kFrom_x_m = 0.40, kTo_x_m = 0.62, kFrom_y_m = 0.40, kTo_y_m = 0.56;
  std::map<int, std::pair<double, int>> celsius_by_bin;
  for (const CheckedPoint& point :
       CheckModel(scan.scene(), scan.band(), model.tsdf(), model.thermal(), pool)) {
    const Eigen::Vector3d& p = point.truth.p_world;
    if (!point.measured() || p.x() < kFrom_x_m || p.x() > kTo_x_m || p.y() < kFrom_y_m ||
        p.y() > kTo_y_m || std::abs(p.z() - BarWall::kWall_m) > 1e-6)
      continue;
    auto& [sum, count] = celsius_by_bin[static_cast<int>(std::floor(p.x() / kBin_m))];
    sum += static_cast<double>(point.point.celsius);
    ++count;
  }
  return EdgeOffset(celsius_by_bin, kBin_m);
}

ThermalFramePtr Delayed(const ThermalFramePtr& frame, double seconds) {
  auto delayed = std::make_shared<ThermalFrame>(*frame);
  delayed->header.capture_time += FromSeconds(seconds);
  return delayed;
}

struct Passing {
  double speed_m_s = 0.0;
  double pose_error_mm = 0.0;      ///< How far to the right the tracker thinks the rig is, mean.
  std::vector<double> offsets_mm;  ///< Per time error.
};

Result<Passing> PassBars(const std::vector<double>& time_errors_s, ThreadPool& pool) {
  SimulationOptions cameras = ExperimentCameras(kDuration_s, kSharpEverywhere);
  cameras.mutable_thermal()->set_rate_hz(30.0);
  // A third of a millimetre is a fifth of a pixel: what is put off here is put off by times alone.
  cameras.set_ideal_cameras(true);
  cameras.mutable_thermal()->mutable_expert()->set_rays_per_pixel_side(1);
  const auto scan = SimulatedScan::Create(cameras, PassAlongBars());
  if (!scan) return Err(scan.error());
  std::vector<std::unique_ptr<GroundPipeline>> pipelines;
  for (std::size_t i = 0; i < time_errors_s.size(); ++i) {
    auto pipeline = StartPipeline(Believing(), **scan, pool);
    if (!pipeline) return Err(pipeline.error());
    pipelines.push_back(std::move(*pipeline));
  }
  const CaptureTime start = (*scan)->depth_times().front().exposure;
  double pose_errors_m = 0.0;
  int poses = 0;
  PlayScan(**scan, pool,
           {[&](const DepthFrame& frame) {
              for (const auto& pipeline : pipelines) pipeline->ProcessDepth(frame);
              const auto tracked = pipelines.front()->model().motion.last();
              if (frame.header.capture_time < start + FromSeconds(kPassing_s) || !tracked) return;
              pose_errors_m += (tracked->T_map_depth.translation() -
                                (*scan)->PoseAt(frame.header.capture_time).translation())
                                   .x();
              ++poses;
            },
            [&](const ThermalFramePtr& frame) {
              // Until the rig has its speed, nothing is measured.
              if (frame->header.capture_time < start + FromSeconds(kPassing_s)) return;
              for (std::size_t i = 0; i < pipelines.size(); ++i)
                pipelines[i]->ProcessThermal(Delayed(frame, time_errors_s[i]));
            }});
  Passing passing;
  const CaptureTime from = start + FromSeconds(kPassing_s), to = start + FromSeconds(kDuration_s);
  passing.speed_m_s =
      TranslationDistance((*scan)->PoseAt(from), (*scan)->PoseAt(to)) / (kDuration_s - kPassing_s);
  passing.pose_error_mm = kMmPerM * pose_errors_m / poses;
  for (const auto& pipeline : pipelines) {
    pipeline->Finish();
    if (Status status = CheckTracked(pipeline->model()); !status.ok()) return Err(status);
    passing.offsets_mm.push_back(kMmPerM * MeasureOffset(**scan, pipeline->model(), pool));
  }
  return passing;
}

}  // namespace

Result<ExperimentReport> RunTimingExperiment(ThreadPool& pool) {
  ExperimentReport report;
  report.table.rows_are = "what is wrong";
  report.table.columns = {"expected offset [mm]", "by the thesis [mm]", "offset in the model [mm]"};
  const Analysis analysis = Analyse(report);
  const std::vector<double> time_errors_s = {0.0, kTimeError_s, -kTimeError_s};
  const Result<Passing> passing = PassBars(time_errors_s, pool);
  if (!passing) return Err(passing.error());
  report.table.rows.push_back(
      {"pose of the tracker, mean over the pass", {passing->pose_error_mm, NAN, NAN}});
  double off_closed_form_mm = 0.0;
  for (std::size_t i = 0; i < time_errors_s.size(); ++i) {
    // A frame that says it is late is taken for one from where the rig was later.
    const double expected_mm =
        passing->pose_error_mm + kMmPerM * passing->speed_m_s * time_errors_s[i];
    const double off_mm = std::abs(passing->offsets_mm[i] - expected_mm);
    if (!(off_mm <= off_closed_form_mm)) off_closed_form_mm = off_mm;  // NaN is not met.
    report.table.rows.push_back({fmt::format("time {:+.0f} ms, {:.2f} m/s, bars in the model",
                                             1e3 * time_errors_s[i], passing->speed_m_s),
                                 {expected_mm, NAN, passing->offsets_mm[i]}});
  }
  const auto beyond_tracker_mm = [&](std::size_t i) {
    return std::abs(passing->offsets_mm[i] - passing->pose_error_mm);
  };
  const Requirement right = {"offset of the bars beyond the tracker's own, right times",
                             beyond_tracker_mm(0), Requirement::Sense::kAtMost, 0.3, "mm"};
  report.requirements = {{"interpolation, off the thesis's figures", analysis.off_thesis_mm,
                          Requirement::Sense::kAtMost, 0.06, "mm"},
                         {"linear interpolation on an arc at thesis speed", analysis.arc_mm,
                          Requirement::Sense::kAtMost, 0.03, "mm"},
                         right,
                         NegativeControl(right, "the same, times 6 ms late", beyond_tracker_mm(1)),
                         {"offset of the bars, off pose error + speed x time error",
                          off_closed_form_mm, Requirement::Sense::kAtMost, 0.3, "mm"}};
  return report;
}

}  // namespace isotherm
