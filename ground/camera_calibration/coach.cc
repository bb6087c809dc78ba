#include "ground/camera_calibration/coach.h"

#include <fmt/format.h>

#include "ground/camera_calibration/opencv_calibration.h"
#include "ground/camera_calibration/projection_map.h"

namespace isotherm {
namespace {

/// Centres of images of holes are that uncertain, all in all.
constexpr double kFeatureSigma_px = 0.02;
/// Three views tell a lens at all (Zhang 2000), six how certain it is, roughly.
constexpr std::size_t kMinForLens = 3, kMinForUncertainty = 6;

/// The lens that a camera is taken to have before anything is known.
LensParameters Nominal(const Eigen::Vector2i& size_px) {
  return {1.0 * size_px.x(), 1.0 * size_px.x(), 0.5 * (size_px.x() - 1), 0.5 * (size_px.y() - 1)};
}

std::vector<FeatureObservation> Observations(
    const std::vector<std::vector<Eigen::Vector2d>>& views) {
  std::vector<FeatureObservation> observations;
  for (std::size_t view = 0; view < views.size(); ++view) {
    for (std::size_t i = 0; i < views[view].size(); ++i)
      observations.push_back({0, static_cast<int>(view), static_cast<int>(i), views[view][i],
                              kFeatureSigma_px * kFeatureSigma_px * Eigen::Matrix2d::Identity()});
  }
  return observations;
}

/// The middle of the board, where a pose is measured to.
RigidTransform MiddleOf(const CalibrationTarget& target, const RigidTransform& T_camera_board) {
  RigidTransform pose = T_camera_board;
  const Eigen::Vector2d middle = target.Middle();
  pose.translation() = T_camera_board * Eigen::Vector3d(middle.x(), middle.y(), 0.0);
  return pose;
}

}  // namespace

std::string CoachStatus::Line() const {
  std::string line = fmt::format("{}: {} views", camera, views);
  if (uncertainty_px) {
    line += fmt::format(", uncertain by {:.3f} px (corners {:.2f})", *uncertainty_px,
                        *max_uncertainty_px);
  }
  if (!missing.empty()) {
    line += fmt::format("; next: {}", missing.front());
    if (missing.size() > 1) line += fmt::format(" and {} more", missing.size() - 1);
  } else {
    line += "; nothing is missing";
  }
  return line;
}

CalibrationCoach::CalibrationCoach(const CalibrationTarget& target,
                                   std::vector<std::string> camera_names,
                                   const std::vector<LensKind>& lenses)
    : target_(target), cameras_(camera_names.size()), status_(camera_names.size()) {
  for (std::size_t i = 0; i < camera_names.size(); ++i) {
    cameras_[i].lens = lenses[i];
    status_[i].camera = std::move(camera_names[i]);
    status_[i].missing = ViewCoverage({1, 1}).Missing();
  }
}

void CalibrationCoach::Add(int camera, const Image<float>& image) {
  const auto index = static_cast<std::size_t>(camera);
  CoachStatus& status = status_[index];
  const Eigen::Vector2i size(image.width(), image.height());
  if (cameras_[index].size_px == Eigen::Vector2i::Zero()) cameras_[index].size_px = size;
  Result<DetectedTarget> detected = DetectTarget(image, target_);
  if (!detected || size != cameras_[index].size_px) {
    ++status.refused;
    status.last_refusal = detected ? "another image size" : detected.error().message();
    return;
  }
  cameras_[index].views.push_back(std::move(detected->features));
  Update(camera);
}

void CalibrationCoach::Update(int camera) {
  const auto index = static_cast<std::size_t>(camera);
  const Camera& c = cameras_[index];
  CoachStatus& status = status_[index];
  BundleState state;
  state.cameras.push_back({LensKind::kBrownConrady, Nominal(c.size_px), {}});
  state.cameras.front().T_camera_rig = RigidTransform::Identity();
  bool solved = false;
  if (c.views.size() >= kMinForLens) {
    const auto start = StartWithOpenCv(target_, c.views, c.size_px);
    if (start) {
      state.cameras.front().lens = start->lens;
      state.T_rig_board = start->T_camera_board;
      solved = true;
    }
  }
  ViewCoverage coverage(c.size_px);
  for (std::size_t i = 0; i < c.views.size(); ++i) {
    const RigidTransform pose =
        solved ? state.T_rig_board[i] : FindPose(target_, c.views[i], state.cameras.front().lens);
    coverage.Add(c.views[i], MiddleOf(target_, pose));
  }
  status.views = coverage.views();
  status.zones.assign(coverage.zones().begin(), coverage.zones().end());
  status.missing = coverage.Missing();
  status.uncertainty_px = status.max_uncertainty_px = std::nullopt;
  if (!solved || c.views.size() < kMinForUncertainty) return;
  state.cameras.front() = AsStart(state.cameras.front().lens, c.lens);
  const std::vector<FeatureObservation> observations = Observations(c.views);
  if (!SolveBundle(target_, observations, {}, state)) return;
  const Result<ReducedSystem> system = ReduceBundle(target_, observations, {}, state);
  if (!system) return;
  const int lens = LensParameterCount(c.lens);
  const ProjectionMap sigmas = ProjectionSigmas(
      state.cameras.front(), system->Covariance().topLeftCorner(lens, lens), c.size_px);
  status.uncertainty_px = sigmas.Rms(true);
  status.max_uncertainty_px = sigmas.Max(false);
}

}  // namespace isotherm
