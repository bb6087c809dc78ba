#include "ground/camera_calibration/calibration_report.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>

#include "ground/camera_calibration/transfer.h"
#include "ground/camera_calibration/view_coverage.h"

namespace isotherm {
namespace {

/// The larger of what the features' scatter and what the choice of views says, both over the inner
/// image: neither sees all errors.
Eigen::MatrixXd ReportedCovariance(const BundleCamera& camera, const Eigen::Vector2i& size_px,
                                   const Eigen::MatrixXd& from_scatter,
                                   const Eigen::MatrixXd& from_views) {
  const double scatter = ProjectionSigmas(camera, from_scatter, size_px).Rms(true);
  const double views = ProjectionSigmas(camera, from_views, size_px).Rms(true);
  if (!(views > scatter)) return from_scatter;
  const double factor = views / scatter;
  return factor * factor * from_scatter;
}

std::vector<std::string> MissingViews(const TargetCalibration& calibration, int camera) {
  ViewCoverage coverage(calibration.sizes_px[static_cast<std::size_t>(camera)]);
  std::map<int, std::vector<Eigen::Vector2d>> views;
  for (const FeatureObservation& o : calibration.observations) {
    if (o.camera == camera) views[o.view].push_back(o.pixel);
  }
  const RigidTransform& T_camera_rig =
      calibration.state.cameras[static_cast<std::size_t>(camera)].T_camera_rig;
  const Eigen::Vector2d middle = calibration.target.Middle();
  for (const auto& [view, features] : views) {
    RigidTransform pose =
        T_camera_rig * calibration.state.T_rig_board[static_cast<std::size_t>(view)];
    pose.translation() = pose * Eigen::Vector3d(middle.x(), middle.y(), 0.0);
    coverage.Add(features, pose);
  }
  return coverage.Missing();
}

void AddSubsets(const TargetCalibration& calibration, int camera, CalibratedCamera& report) {
  for (const FeatureSubset subset : {FeatureSubset::kNearBorders, FeatureSubset::kNearMiddle}) {
    const Result<TargetCalibration> part = CalibrateFromSubset(calibration, camera, subset);
    if (!part) continue;
    report.subsets.push_back({subset, part->state.cameras.front(), part->LensCovariance(0),
                              ReprojectionErrorOf(*part, 0)});
  }
}

void AddOpenCv(const TargetCalibration& calibration, int camera, CalibratedCamera& report) {
  std::vector<std::vector<Eigen::Vector2d>> views;
  for (const auto& view : calibration.detections[static_cast<std::size_t>(camera)]) {
    if (!view.empty()) views.push_back(view);
  }
  const Result<OpenCvCalibration> opencv =
      CalibrateWithOpenCv(calibration.target, views, report.size_px, report.camera.kind);
  if (!opencv) return;
  report.opencv = *opencv;
  const BundleCamera other{report.camera.kind, opencv->lens, RigidTransform::Identity()};
  report.off_opencv_px = CompareProjections(report.camera, other, report.size_px).Rms(true);
}

CalibratedCamera ReportCamera(const TargetCalibration& calibration, int camera,
                              const ReportOptions& options) {
  const auto index = static_cast<std::size_t>(camera);
  CalibratedCamera report;
  report.camera = calibration.state.cameras[index];
  report.size_px = calibration.sizes_px[index];
  report.hole = calibration.holes[index];
  std::set<int> views;
  for (std::size_t i = 0; i < calibration.observations.size(); ++i) {
    const FeatureObservation& o = calibration.observations[i];
    if (o.camera != camera) continue;
    views.insert(o.view);
    report.features_px.push_back(o.pixel);
    report.residuals_px.push_back(calibration.fit.residuals_px[i]);
  }
  report.views = static_cast<int>(views.size());
  report.features = static_cast<int>(report.features_px.size());
  report.error = ReprojectionErrorOf(calibration, camera);
  report.bootstrap = BootstrapLens(calibration, camera, options.bootstrap_samples, options.seed);
  report.covariance =
      ReportedCovariance(report.camera, report.size_px, calibration.LensCovariance(camera),
                         report.bootstrap.Covariance());
  report.sigmas = ProjectionSigmas(report.camera, report.covariance, report.size_px);
  if (Result<std::vector<double>> sensitivity = ParameterSensitivity(calibration, camera, 0.1))
    report.sensitivity = std::move(*sensitivity);
  AddSubsets(calibration, camera, report);
  report.missing = MissingViews(calibration, camera);
  AddOpenCv(calibration, camera, report);
  return report;
}

void ReportBoard(const TargetCalibration& calibration, CalibrationReport& report) {
  constexpr double kMillimetres = 1e3;
  for (const double term : calibration.state.board.warp_m)
    report.warp_mm.push_back(kMillimetres * term);
  double low = std::numeric_limits<double>::infinity(), high = -low, squares = 0.0;
  const Eigen::Vector2d middle = calibration.target.Middle(), half = calibration.target.HalfSize();
  for (int i = 0; i < calibration.target.features(); ++i) {
    const Eigen::Vector2d place =
        (calibration.target.FeaturePosition(i) - middle).cwiseQuotient(half);
    const double z = calibration.state.board.Z(place.x(), place.y());
    low = std::min(low, z);
    high = std::max(high, z);
    squares += calibration.state.board.offsets_m[static_cast<std::size_t>(i)].squaredNorm();
  }
  report.board_depth_mm = kMillimetres * (high - low);
  report.placement_rms_mm = kMillimetres * std::sqrt(squares / calibration.target.features());
}

}  // namespace

CalibrationReport MakeReport(const TargetCalibration& calibration,
                             const std::vector<std::string>& camera_names,
                             const ReportOptions& options) {
  CalibrationReport report;
  report.target = calibration.target.spec;
  report.refused = calibration.refused;
  Result<std::vector<CrossValidation>> halves = CrossValidate(calibration);
  for (std::size_t i = 0; i < camera_names.size(); ++i) {
    report.cameras.push_back(ReportCamera(calibration, static_cast<int>(i), options));
    report.cameras.back().name = camera_names[i];
    if (halves) report.cameras.back().cross_validation = std::move((*halves)[i]);
  }
  if (camera_names.size() == 2) report.pose = ReportPose(calibration);
  ReportBoard(calibration, report);
  return report;
}

}  // namespace isotherm
