#include "ground/camera_calibration/transfer.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "ground/camera_calibration/lens_rays.h"
#include "ground/camera_calibration/resampling.h"

namespace isotherm {
namespace {

constexpr int kPose = 6;
constexpr double kTransferDepth_m = 0.6;

/// The state with one of its shared parameters moved, numbered as in ReducedSystem.
BundleState Moved(const BundleState& state, const ReducedSystem& system, int parameter,
                  double step) {
  BundleState moved = state;
  for (std::size_t i = 0; i < state.cameras.size(); ++i) {
    const int count = LensParameterCount(state.cameras[i].kind);
    const int in_lens = parameter - system.lens_at[i], in_pose = parameter - system.pose_at[i];
    if (in_lens >= 0 && in_lens < count)
      moved.cameras[i].lens[static_cast<std::size_t>(in_lens)] += step;
    if (system.pose_at[i] < 0 || in_pose < 0 || in_pose >= kPose) continue;
    MovePose(in_pose, step, moved.cameras[i].T_camera_rig);
  }
  return moved;
}

/// Where the target's pose in one camera comes from the other one's image of it: mean reprojection
/// error over the views that both saw (thesis 5.2.4).
double CrossError(const TargetCalibration& calibration, int from, int to) {
  BundleState state = SingleCamera(calibration, from).state;
  const auto f = static_cast<std::size_t>(from), t = static_cast<std::size_t>(to);
  std::vector<FeatureObservation> seen;
  std::map<int, int> both;
  for (const FeatureObservation& o : calibration.observations) both[o.view] |= 1 << o.camera;
  for (FeatureObservation o : calibration.observations) {
    if (o.camera != from) continue;
    o.camera = 0;
    seen.push_back(o);
  }
  BundleOptions poses_only;
  poses_only.estimate_board = false;
  poses_only.fix_lenses = true;
  if (!SolveBundle(calibration.target, seen, poses_only, state)) return std::nan("");
  const RigidTransform T_to_from = calibration.state.cameras[t].T_camera_rig *
                                   calibration.state.cameras[f].T_camera_rig.inverse();
  state.cameras = {calibration.state.cameras[t]};
  state.cameras.front().T_camera_rig = T_to_from;
  double sum = 0.0;
  int count = 0;
  for (const FeatureObservation& o : calibration.observations) {
    if (o.camera != to || both[o.view] != 3) continue;
    const Eigen::Vector2d predicted = ProjectBoardPoint(state, calibration.target, 0, o.view,
                                                        o.feature, Eigen::Vector2d::Zero(), 0.0);
    sum += (o.pixel - predicted).norm();
    ++count;
  }
  return count > 0 ? sum / count : std::nan("");
}

/// Standard deviations of TransferPoints by all shared parameters together.
double TransferSigma(const TargetCalibration& calibration, const Eigen::MatrixXd& covariance) {
  const ReducedSystem& system = calibration.system;
  const Eigen::Vector2i &first = calibration.sizes_px[0], &second = calibration.sizes_px[1];
  // Lenses and pose; the board is not part of the rig.
  const int parameters = system.pose_at[1] + kPose;
  const ProjectionMap before = TransferPoints(calibration.state, first, second, kTransferDepth_m);
  std::vector<Eigen::Matrix2Xd> slopes(before.values_px.size(),
                                       Eigen::Matrix2Xd::Zero(2, parameters));
  for (int i = 0; i < parameters; ++i) {
    constexpr double kStep = 1e-5;
    const ProjectionMap after =
        TransferPoints(Moved(calibration.state, system, i, kStep), first, second, kTransferDepth_m);
    for (std::size_t j = 0; j < slopes.size(); ++j)
      slopes[j].col(i) = (after.values_px[j] - before.values_px[j]) / kStep;
  }
  ProjectionMap sigmas = before;
  for (std::size_t j = 0; j < slopes.size(); ++j) {
    const Eigen::Matrix2d at =
        slopes[j] * covariance.topLeftCorner(parameters, parameters) * slopes[j].transpose();
    sigmas.values_px[j] = at.diagonal().cwiseMax(0.0).cwiseSqrt();
  }
  return sigmas.Rms(true);
}

}  // namespace

void MovePose(int parameter, double step, RigidTransform& pose) {
  if (parameter >= 3) {
    pose.translation()[parameter - 3] += step;
    return;
  }
  // The rotation vector changes in itself, as in the bundle.
  const Eigen::AngleAxisd rotation(pose.linear());
  Eigen::Vector3d vector = rotation.angle() * rotation.axis();
  vector[parameter] += step;
  const double angle = vector.norm();
  if (angle > 0.0) pose.linear() = Eigen::AngleAxisd(angle, vector / angle).toRotationMatrix();
}

ProjectionMap TransferPoints(const BundleState& state, const Eigen::Vector2i& first_size_px,
                             const Eigen::Vector2i& second_size_px, double depth_m) {
  ProjectionMap map;
  map.size_px = first_size_px;
  const BundleCamera &first = state.cameras[0], &second = state.cameras[1];
  for (int i = 0; i < ProjectionMap::kColumns * ProjectionMap::kRows; ++i) {
    Eigen::Vector2d pixel = Eigen::Vector2d::Constant(std::nan(""));
    if (const auto ray = RayThrough(first.kind, first.lens, map.PixelOf(i))) {
      const Eigen::Vector2d at =
          ProjectRay(second.kind, second.lens,
                     second.T_camera_rig * (first.T_camera_rig.inverse() * (depth_m * *ray)));
      const bool inside = at.x() >= 0.0 && at.y() >= 0.0 && at.x() < second_size_px.x() &&
                          at.y() < second_size_px.y();
      if (inside) pixel = at;
    }
    map.values_px.push_back(pixel);
  }
  return map;
}

PoseReport ReportPose(const TargetCalibration& calibration) {
  PoseReport report;
  report.T_second_first = calibration.state.cameras[1].T_camera_rig;
  const Eigen::MatrixXd covariance =
      std::max(1.0, calibration.fit.variance_factor) * calibration.system.Covariance();
  const int at = calibration.system.pose_at[1];
  report.covariance = covariance.block<kPose, kPose>(at, at);
  std::map<int, int> both;
  for (const FeatureObservation& o : calibration.observations) both[o.view] |= 1 << o.camera;
  report.views = static_cast<int>(
      std::count_if(both.begin(), both.end(), [](const auto& view) { return view.second == 3; }));
  report.transfer_sigma_px = TransferSigma(calibration, covariance);
  report.first_to_second_px = CrossError(calibration, 0, 1);
  report.second_to_first_px = CrossError(calibration, 1, 0);
  return report;
}

}  // namespace isotherm
