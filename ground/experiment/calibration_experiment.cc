#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "common/base/units.h"
#include "ground/camera_calibration/calibration_report.h"
#include "ground/camera_calibration/simulated_session.h"
#include "ground/camera_calibration/transfer.h"
#include "ground/experiment/experiment.h"
#include "ground/experiment/histogram_rendering.h"

namespace isotherm {
namespace {

// As in the thesis: 30 poses, of which 20 at a time were calibrated from, 10000 times (5.2.3).
constexpr int kViews = 30, kChosen = 20, kSamples = 10000;
// Boards from flat to warped by 2 mm.
constexpr int kSessions = 10;
constexpr double kMaxWarp_m = 0.002;
constexpr double kMillimetres = 1e3;

/// Units of the thesis's tables: pixels, then thousandths and millionths.
constexpr double kUnits[] = {1.0, 1.0, 1.0, 1.0, 1e3, 1e3, 1e6, 1e6, 1e3};

ExperimentTable::Row LensRow(std::string label, double error_px, const Eigen::VectorXd& values) {
  ExperimentTable::Row row{std::move(label), {error_px}};
  for (int i = 0; i < 9; ++i) row.values.push_back(kUnits[i] * values(i));
  return row;
}

Eigen::VectorXd Values(const BundleCamera& camera) {
  return Eigen::Map<const Eigen::VectorXd>(camera.lens.data(), 9);
}

/// The rows of tables 5.1a, 5.2 and 5.3 for one camera.
void DescribeCamera(const TargetCalibration& calibration, int camera, const BundleCamera& truth,
                    const CalibratedCamera& report, ExperimentReport& experiment) {
  auto& rows = experiment.table.rows;
  const std::string& name = report.name;
  rows.push_back(LensRow(name + ", true", NAN, Values(truth)));
  rows.push_back(LensRow(name + ", all features", report.error.rms_px, Values(report.camera)));
  const LensSamples subsets = SubsetLens(calibration, camera, kChosen, kSamples, 1);
  rows.push_back(
      LensRow(name + ", +- (20 of 30 views)", NAN, subsets.Covariance().diagonal().cwiseSqrt()));
  rows.push_back(LensRow(name + ", +- (reported)", NAN, report.covariance.diagonal().cwiseSqrt()));
  for (const CalibratedCamera::Subset& subset : report.subsets) {
    const char* const where = subset.features == FeatureSubset::kNearBorders ? "borders" : "middle";
    rows.push_back(LensRow(fmt::format("{}, features near {}", name, where), subset.error.rms_px,
                           Values(subset.camera)));
  }
  if (report.opencv)
    rows.push_back(LensRow(name + ", OpenCV", report.opencv->rms_px,
                           Eigen::Map<const Eigen::VectorXd>(report.opencv->lens.data(), 9)));
  // Table 5.2, in per cent of the parameter.
  ExperimentTable::Row change{name + ", % for 0.1 px more error", {0.1}};
  for (std::size_t i = 0; i < report.sensitivity.size(); ++i)
    change.values.push_back(100.0 * report.sensitivity[i] / std::abs(report.camera.lens[i]));
  rows.push_back(std::move(change));
  experiment.renderings.push_back({name + "_histograms", HistogramRendering(subsets.values)});
}

/// How far single sessions are off the truth, the worst of all.
struct WorstOff {
  double thermal_px = 0.0, thermal_max_px = 0.0, depth_px = 0.0;
  double opencv_thermal_px = 1e9, opencv_depth_px = 1e9;
  double holes_in_depth_px = 0.0, opencv_holes_in_depth_px = 1e9;
  double degrees = 0.0, mm = 0.0, transfer_px = 0.0;
  double within_sum = 0.0;
  int within_count = 0;
};

BundleCamera OpenCvCamera(const CalibratedCamera& report) {
  return {LensKind::kBrownConrady, report.opencv ? report.opencv->lens : LensParameters{},
          RigidTransform::Identity()};
}

void MeasureCamera(const CalibratedCamera& report, const BundleCamera& truth, bool thermal,
                   WorstOff& worst) {
  const ProjectionMap off = CompareProjections(truth, report.camera, report.size_px);
  const double opencv = CompareProjections(truth, OpenCvCamera(report), report.size_px).Rms(true);
  double& rms = thermal ? worst.thermal_px : worst.depth_px;
  double& other = thermal ? worst.opencv_thermal_px : worst.opencv_depth_px;
  rms = std::max(rms, off.Rms(true));
  other = std::min(other, opencv);
  if (thermal) worst.thermal_max_px = std::max(worst.thermal_max_px, off.Max(true));
  worst.within_sum += FractionWithin(off, report.sigmas, 2.0);
  ++worst.within_count;
}

void MeasurePose(const TargetCalibration& calibration, WorstOff& worst) {
  const RigidTransform pose = calibration.state.cameras[1].T_camera_rig;
  const RigidTransform truth = ThesisThermalFromDepth();
  worst.degrees = std::max(worst.degrees, RotationAngle(pose, truth) / kRadPerDeg);
  worst.mm = std::max(worst.mm, kMillimetres * TranslationDistance(pose, truth));
  BundleState true_state = calibration.state;
  true_state.cameras = {ToBundle(ThesisDepth()), ToBundle(ThesisThermal())};
  true_state.cameras[1].T_camera_rig = truth;
  for (const double depth_m : {0.4, 0.65, 0.9}) {
    ProjectionMap off =
        TransferPoints(true_state, calibration.sizes_px[0], calibration.sizes_px[1], depth_m);
    const ProjectionMap ours = TransferPoints(calibration.state, calibration.sizes_px[0],
                                              calibration.sizes_px[1], depth_m);
    for (std::size_t i = 0; i < off.values_px.size(); ++i) off.values_px[i] -= ours.values_px[i];
    worst.transfer_px = std::max(worst.transfer_px, off.Rms(true));
  }
}

/// The depth camera of the same session by its depth images instead of its infrared ones. OpenCV is
/// held against warped boards only.
Status MeasureHolesInDepth(TargetSession session, bool warped, ThreadPool& pool, WorstOff& worst) {
  session.thermal = false;
  session.depth_images = TargetSession::DepthImages::kDepth;
  const auto calibration = CalibrateWithTarget(TakeViews(session, pool), pool, [](double) {});
  if (!calibration) return calibration.error();
  const CalibrationReport made = MakeReport(*calibration, {"depth"}, {});
  const BundleCamera truth = ToBundle(ThesisDepth());
  const CalibratedCamera& depth = made.cameras.front();
  const double off = CompareProjections(truth, depth.camera, depth.size_px).Rms(true);
  worst.holes_in_depth_px = std::max(worst.holes_in_depth_px, off);
  if (!warped) return OkStatus();
  const double opencv = CompareProjections(truth, OpenCvCamera(depth), depth.size_px).Rms(true);
  worst.opencv_holes_in_depth_px = std::min(worst.opencv_holes_in_depth_px, opencv);
  return OkStatus();
}

void Require(const WorstOff& worst, ExperimentReport& report) {
  const auto most = [&](const char* what, double measured, double limit, const char* unit) {
    report.requirements.push_back({what, measured, Requirement::Sense::kAtMost, limit, unit});
    return report.requirements.back();
  };
  const Requirement thermal =
      most("thermal projection off the truth, inner 80 %, rms, worst session", worst.thermal_px,
           0.12, "px");
  report.requirements.push_back(
      NegativeControl(thermal, "the same by OpenCV, best warped session", worst.opencv_thermal_px));
  most("the same, largest", worst.thermal_max_px, 0.5, "px");
  const Requirement depth =
      most("infrared projection off the truth, inner 80 %, rms, worst session", worst.depth_px, 0.3,
           "px");
  report.requirements.push_back(
      NegativeControl(depth, "the same by OpenCV, best warped session", worst.opencv_depth_px));
  const Requirement holes = most("depth camera by holes in depth alone, the same, worst session",
                                 worst.holes_in_depth_px, 0.5, "px");
  report.requirements.push_back(NegativeControl(holes, "the same by OpenCV, best warped session",
                                                worst.opencv_holes_in_depth_px));
  report.requirements.push_back({"pixels at which the truth is within two standard deviations",
                                 100.0 * worst.within_sum / worst.within_count,
                                 Requirement::Sense::kAtLeast, 90.0, "%"});
  most("rotation between the cameras off, worst session", worst.degrees, 0.05, "degrees");
  most("translation between the cameras off, worst session", worst.mm, 0.7, "mm");
  most("depth points at 0.4 to 0.9 m land off in the thermal image, rms, worst session",
       worst.transfer_px, 0.15, "px");
}

void DescribePose(const PoseReport& pose, ExperimentReport& report) {
  const Eigen::Vector3d t = kMillimetres * pose.T_second_first.translation();
  const auto sigma = [&](int i) { return kMillimetres * std::sqrt(pose.covariance(i, i)); };
  report.table.rows.push_back({"infrared to thermal: error, tx ty tz [mm], their +-",
                               {pose.first_to_second_px, t.x(), t.y(), t.z(), sigma(3), sigma(4),
                                sigma(5), NAN, NAN, NAN}});
}

}  // namespace

Result<ExperimentReport> RunCalibrationExperiment(ThreadPool& pool) {
  ExperimentReport report;
  report.table.rows_are = "calibration";
  report.table.columns = {"error [px]", "fu [px]",   "fv [px]",   "cu [px]",   "cv [px]",
                          "k1 [1e-3]",  "k2 [1e-3]", "p1 [1e-6]", "p2 [1e-6]", "k3 [1e-3]"};
  WorstOff worst;
  for (int i = 0; i < kSessions; ++i) {
    TargetSession session;
    session.seed = static_cast<std::uint64_t>(i + 1);
    session.board = WarpedBoard(kMaxWarp_m * i / (kSessions - 1), session.seed);
    session.count = kViews;
    session.depth = true;
    const auto calibration = CalibrateWithTarget(TakeViews(session, pool), pool, [](double) {});
    if (!calibration) return Err(calibration.error());
    const CalibrationReport made = MakeReport(*calibration, {"infrared", "thermal"}, {});
    // OpenCV is held against boards that are warped by half a millimetre or more.
    WorstOff before = worst;
    MeasureCamera(made.cameras[0], ToBundle(ThesisDepth()), false, worst);
    MeasureCamera(made.cameras[1], ToBundle(ThesisThermal()), true, worst);
    constexpr int kWarped = 3;
    if (i < kWarped) {
      worst.opencv_depth_px = before.opencv_depth_px;
      worst.opencv_thermal_px = before.opencv_thermal_px;
    }
    MeasurePose(*calibration, worst);
    Status measured = MeasureHolesInDepth(session, i >= kWarped, pool, worst);
    if (!measured.ok()) return Err(measured);
    if (i != kSessions / 2) continue;
    DescribeCamera(*calibration, 0, ToBundle(ThesisDepth()), made.cameras[0], report);
    DescribeCamera(*calibration, 1, ToBundle(ThesisThermal()), made.cameras[1], report);
    DescribePose(*made.pose, report);
  }
  Require(worst, report);
  return report;
}

}  // namespace isotherm
