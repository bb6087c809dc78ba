#include "ground/camera_calibration/resampling.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

#include "common/base/noise.h"

namespace isotherm {
namespace {

/// A whole number in [0, count).
std::size_t Draw(std::uint64_t stream, std::uint64_t counter, std::size_t count) {
  return std::min(count - 1, static_cast<std::size_t>(UniformNoise(stream, counter) *
                                                      static_cast<double>(count)));
}

/// Lens parameters after one Gauss-Newton step from the solution for each weighting of the views.
template <typename WeightsOf>
LensSamples Resample(const TargetCalibration& calibration, int camera, int samples,
                     const WeightsOf& weights_of) {
  const BundleCamera& c = calibration.state.cameras[static_cast<std::size_t>(camera)];
  const int count = LensParameterCount(c.kind);
  const int at = calibration.system.lens_at[static_cast<std::size_t>(camera)];
  const Eigen::VectorXd solution = Eigen::Map<const Eigen::VectorXd>(c.lens.data(), count);
  LensSamples result;
  result.values.resize(samples, count);
  for (int i = 0; i < samples; ++i) {
    const Eigen::VectorXd step = calibration.system.Step(weights_of(static_cast<std::uint64_t>(i)));
    result.values.row(i) = (solution + step.segment(at, count)).transpose();
  }
  return result;
}

/// Returns the observations of every second view, by the order in which they were taken: neighbours
/// are alike, so that both halves see much the same.
std::vector<FeatureObservation> HalfOf(const TargetCalibration& calibration, int half) {
  std::vector<FeatureObservation> observations;
  for (const FeatureObservation& o : calibration.observations) {
    if (o.view % 2 == half) observations.push_back(o);
  }
  return observations;
}

}  // namespace

Eigen::VectorXd LensSamples::Mean() const { return values.colwise().mean().transpose(); }

Eigen::MatrixXd LensSamples::Covariance() const {
  const Eigen::MatrixXd centred = values.rowwise() - values.colwise().mean();
  return centred.transpose() * centred /
         static_cast<double>(std::max<Eigen::Index>(1, values.rows() - 1));
}

LensSamples BootstrapLens(const TargetCalibration& calibration, int camera, int samples,
                          std::uint64_t seed) {
  constexpr std::uint64_t kPurpose = 0x626f6f74;
  const std::size_t views = calibration.system.views.size();
  return Resample(calibration, camera, samples, [&](std::uint64_t sample) {
    std::vector<double> weights(views, 0.0);
    const std::uint64_t stream = NoiseStream(seed, kPurpose, sample);
    for (std::size_t i = 0; i < views; ++i) weights[Draw(stream, i, views)] += 1.0;
    return weights;
  });
}

LensSamples SubsetLens(const TargetCalibration& calibration, int camera, int chosen, int samples,
                       std::uint64_t seed) {
  constexpr std::uint64_t kPurpose = 0x73756273;
  const std::size_t views = calibration.system.views.size();
  return Resample(calibration, camera, samples, [&](std::uint64_t sample) {
    const std::uint64_t stream = NoiseStream(seed, kPurpose, sample);
    std::vector<std::size_t> order(views);
    std::iota(order.begin(), order.end(), 0U);
    std::vector<double> weights(views, 0.0);
    for (std::size_t i = 0; i < std::min(views, static_cast<std::size_t>(chosen)); ++i) {
      std::swap(order[i], order[i + Draw(stream, i, views - i)]);
      weights[order[i]] = 1.0;
    }
    return weights;
  });
}

TargetCalibration SingleCamera(const TargetCalibration& calibration, int camera) {
  const auto index = static_cast<std::size_t>(camera);
  TargetCalibration single;
  single.target = calibration.target;
  single.view_names = calibration.view_names;
  single.sizes_px = {calibration.sizes_px[index]};
  single.holes = {calibration.holes[index]};
  single.detections = {calibration.detections[index]};
  single.state.board = calibration.state.board;
  BundleCamera only = calibration.state.cameras[index];
  for (const RigidTransform& pose : calibration.state.T_rig_board)
    single.state.T_rig_board.push_back(only.T_camera_rig * pose);
  only.T_camera_rig = RigidTransform::Identity();
  single.state.cameras = {only};
  for (std::size_t i = 0; i < calibration.observations.size(); ++i) {
    FeatureObservation o = calibration.observations[i];
    if (o.camera != camera) continue;
    o.camera = 0;
    single.observations.push_back(o);
    single.fit.residuals_px.push_back(calibration.fit.residuals_px[i]);
  }
  single.fit.variance_factor = calibration.fit.variance_factor;
  return single;
}

Result<TargetCalibration> Recalibrate(const TargetCalibration& calibration,
                                      const std::vector<FeatureObservation>& observations) {
  TargetCalibration result;
  result.target = calibration.target;
  result.sizes_px = calibration.sizes_px;
  result.holes = calibration.holes;
  result.state.cameras = calibration.state.cameras;
  result.state.board = calibration.state.board;
  std::map<int, int> number;
  for (FeatureObservation o : observations) {
    const auto [found, added] = number.try_emplace(o.view, static_cast<int>(number.size()));
    if (added) {
      result.state.T_rig_board.push_back(
          calibration.state.T_rig_board[static_cast<std::size_t>(o.view)]);
      result.view_names.push_back(calibration.view_names[static_cast<std::size_t>(o.view)]);
    }
    o.view = found->second;
    result.observations.push_back(o);
  }
  Result<BundleFit> fit = SolveBundle(calibration.target, result.observations, {}, result.state);
  if (!fit) return Err(fit.error());
  result.fit = std::move(*fit);
  Result<ReducedSystem> system =
      ReduceBundle(calibration.target, result.observations, {}, result.state);
  if (!system) return Err(system.error());
  result.system = std::move(*system);
  return result;
}

Result<std::vector<CrossValidation>> CrossValidate(const TargetCalibration& calibration) {
  constexpr std::size_t kMinViews = 8;  // Four in each half.
  if (calibration.view_names.size() < kMinViews)
    return Err(FailedPrecondition("too few views for two independent halves"));
  std::vector<TargetCalibration> halves;
  for (const int half : {0, 1}) {
    Result<TargetCalibration> result = Recalibrate(calibration, HalfOf(calibration, half));
    if (!result) return Err(result.error());
    halves.push_back(std::move(*result));
  }
  std::vector<CrossValidation> validations;
  for (std::size_t i = 0; i < calibration.state.cameras.size(); ++i) {
    const Eigen::Vector2i& size = calibration.sizes_px[i];
    const int camera = static_cast<int>(i);
    CrossValidation validation;
    validation.difference =
        CompareProjections(halves[0].state.cameras[i], halves[1].state.cameras[i], size);
    validation.expected =
        ProjectionSigmas(calibration.state.cameras[i],
                         halves[0].LensCovariance(camera) + halves[1].LensCovariance(camera), size);
    validations.push_back(std::move(validation));
  }
  return validations;
}

}  // namespace isotherm
