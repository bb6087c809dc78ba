#include "ground/camera_calibration/sensitivity.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <vector>

#include "ground/camera_calibration/resampling.h"

namespace isotherm {

ReprojectionError ReprojectionErrorOf(const TargetCalibration& calibration, int camera) {
  ReprojectionError error;
  int count = 0;
  for (std::size_t i = 0; i < calibration.observations.size(); ++i) {
    if (calibration.observations[i].camera != camera) continue;
    const double length = calibration.fit.residuals_px[i].norm();
    error.rms_px += length * length;
    error.mae_px += length;
    ++count;
  }
  if (count == 0) return {};
  return {std::sqrt(error.rms_px / count), error.mae_px / count};
}

Result<std::vector<double>> ParameterSensitivity(const TargetCalibration& calibration, int camera,
                                                 double increase_px) {
  // In pixels, every feature counting alike, the board as it is.
  TargetCalibration single = SingleCamera(calibration, camera);
  for (FeatureObservation& o : single.observations) o.covariance = Eigen::Matrix2d::Identity();
  Result<TargetCalibration> one = Recalibrate(single, single.observations);
  if (!one) return Err(one.error());
  BundleOptions fixed_board;
  fixed_board.estimate_board = false;
  const Result<ReducedSystem> system =
      ReduceBundle(one->target, one->observations, fixed_board, one->state);
  if (!system) return Err(system.error());
  const int count = LensParameterCount(one->state.cameras.front().kind);
  const double before = ReprojectionErrorOf(*one, 0).rms_px, after = before + increase_px;
  const double added =
      (after * after - before * before) * static_cast<double>(one->observations.size());
  std::vector<double> changes;
  for (int i = 0; i < count; ++i) {
    double curvature = 0.0;
    for (const ReducedSystem::Term& view : system->views) curvature += view.hessian(i, i);
    changes.push_back(std::sqrt(added / std::max(curvature, 1e-30)));
  }
  return changes;
}

Result<TargetCalibration> CalibrateFromSubset(const TargetCalibration& calibration, int camera,
                                              FeatureSubset subset) {
  const TargetCalibration single = SingleCamera(calibration, camera);
  std::map<int, std::vector<FeatureObservation>> views;
  for (const FeatureObservation& o : single.observations) views[o.view].push_back(o);
  const Eigen::Vector2i& size = single.sizes_px.front();
  const Eigen::Vector2d middle = 0.5 * (size.cast<double>() - Eigen::Vector2d::Ones());
  std::vector<FeatureObservation> chosen;
  for (auto& [view, observations] : views) {
    std::sort(observations.begin(), observations.end(), [&](const auto& a, const auto& b) {
      return (a.pixel - middle).squaredNorm() < (b.pixel - middle).squaredNorm();
    });
    const auto half = static_cast<std::ptrdiff_t>(observations.size() / 2);
    const auto first =
        subset == FeatureSubset::kNearBorders ? observations.end() - half : observations.begin();
    const auto end = subset == FeatureSubset::kNearMiddle ? first + half : observations.end();
    std::vector<int> features;
    std::transform(first, end, std::back_inserter(features),
                   [](const auto& o) { return o.feature; });
    if (single.target.TellPose(features)) chosen.insert(chosen.end(), first, end);
  }
  return Recalibrate(single, chosen);
}

}  // namespace isotherm
