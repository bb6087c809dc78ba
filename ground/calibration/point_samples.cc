#include "ground/calibration/point_samples.h"

#include <algorithm>
#include <cmath>

namespace isotherm {
namespace {

// As in TextureConsistency: what a sample differs by without any fault of the calibration.
constexpr double kNoise_k = 0.1;
constexpr double kMisalignment_px = 0.5;
// A mean of fewer frames is mostly one frame's noise.
constexpr double kMinFrames = 8.0, kMinFramesOfEpoch = 4.0;
// The squared gradient over its squared standard error: noise alone is above it at one of 22,000
// points (exp(-10), for two directions and many frames; at one of 500 for the fewest).
constexpr double kMinSignificance = 10.0;
// Where emission angles differ by less than this makes of the reflectivity, nothing is fitted to
// it.
constexpr double kMinReflectivitySpread = 0.0001;

double MinReflectivitySquares(double count) {
  return kMinReflectivitySpread * kMinReflectivitySpread * count;
}

/// Adds `times` the square of a vector to the lower half of a matrix.
void AddSquare(double times, const Eigen::VectorXd& vector, Eigen::MatrixXd& sum) {
  for (Eigen::Index column = 0; column < vector.size(); ++column) {
    const Eigen::Index rest = vector.size() - column;
    sum.col(column).tail(rest) += times * vector[column] * vector.tail(rest);
  }
}

/// Says how the temperature of one sample changes with the placement and with the two knots around
/// it.
struct SampleSlope {
  static constexpr int kKnots = 2 * TrajectoryDrift::kPerKnot;

  SampleSlope(const PointSample& sample, const PointTexture& texture)
      : placement(sample.shift.transpose() * texture.gradient_k_m),
        first(kPlacementParameters + sample.drift.first) {
    const Eigen::Matrix<double, TrajectoryDrift::kPerKnot, 1> drift =
        sample.drift_shift.transpose() * texture.gradient_k_m;
    placement.segment<2>(kNearInfluence) = sample.by_influence;
    knots << (1.0 - sample.drift.fraction) * drift, sample.drift.fraction * drift;
  }

  /// Adds it `times` to a vector of all parameters, with or without those of the drift.
  void AddTo(double times, Eigen::VectorXd& sum) const {
    sum.head<kPlacementParameters>() += times * placement;
    if (sum.size() > kPlacementParameters) sum.segment<kKnots>(first) += times * knots;
  }

  /// Adds its square to the lower half of a matrix of all parameters.
  void AddSquare(double weight, Eigen::MatrixXd& sum) const {
    sum.topLeftCorner<kPlacementParameters, kPlacementParameters>() +=
        weight * placement * placement.transpose();
    if (sum.rows() == kPlacementParameters) return;
    sum.block<kKnots, kPlacementParameters>(first, 0) += weight * knots * placement.transpose();
    sum.block<kKnots, kKnots>(first, first) += weight * knots * knots.transpose();
  }

  PlacementVector placement;
  Eigen::Index first;  ///< The parameter of the first of `knots`.
  Eigen::Matrix<double, kKnots, 1> knots;
};

/// Fits what the samples are compared with.
void Complete(const std::vector<PointSample>& samples, PointEpoch& epoch) {
  const auto for_each = [&](const auto& add) {
    for (std::size_t i = epoch.begin; i < epoch.end; ++i) {
      if (!samples[i].held_out) add(samples[i]);
    }
  };
  for_each([&](const PointSample& sample) {
    epoch.count += 1.0;
    epoch.kelvin += sample.kelvin;
    epoch.reflectivity += sample.reflectivity;
  });
  if (epoch.count == 0.0) return;
  epoch.kelvin /= epoch.count;
  epoch.reflectivity /= epoch.count;
  epoch.reflectivity_squares = MinReflectivitySquares(epoch.count);
  for_each([&](const PointSample& sample) {
    const double reflectivity = sample.reflectivity - epoch.reflectivity;
    epoch.reflectivity_squares += reflectivity * reflectivity;
    epoch.kelvin_by_reflectivity += reflectivity * sample.kelvin;
  });
  epoch.kelvin_by_reflectivity /= epoch.reflectivity_squares;
  for_each([&](const PointSample& sample) {
    const double difference_k = epoch.Difference(sample);
    epoch.squares += difference_k * difference_k;
  });
}

}  // namespace

std::optional<PointTexture> TextureOf(const std::vector<PointSample>& samples) {
  PointTexture texture;
  double count = 0.0, squares = 0.0;
  for (const PointSample& sample : samples) {
    if (sample.held_out) continue;
    count += 1.0;
    texture.gradient_k_m += sample.gradient_k_m;
    texture.mean_slope_k_px += sample.gradient_k_m.norm() / sample.pixels_per_metre;
    squares += sample.gradient_k_m.squaredNorm();
  }
  if (count < kMinFrames) return std::nullopt;
  texture.gradient_k_m /= count;
  texture.mean_slope_k_px /= count;
  const double scatter = squares / count - texture.gradient_k_m.squaredNorm();
  texture.is_significant = texture.gradient_k_m.squaredNorm() >
                           kMinSignificance * std::max(0.0, scatter) / (count - 1.0);
  return texture;
}

std::vector<PointEpoch> EpochsOf(const std::vector<PointSample>& samples) {
  std::vector<PointEpoch> epochs;
  for (std::size_t begin = 0, end = 0; begin < samples.size(); begin = end) {
    while (end < samples.size() && samples[end].epoch == samples[begin].epoch) ++end;
    PointEpoch epoch{begin, end};
    Complete(samples, epoch);
    if (epoch.count >= kMinFramesOfEpoch) epochs.push_back(epoch);
  }
  return epochs;
}

std::optional<double> VarianceOf(const std::vector<PointEpoch>& epochs) {
  double count = 0.0, squares = 0.0;
  for (const PointEpoch& epoch : epochs) {
    count += epoch.count;
    squares += epoch.squares;
  }
  if (count == 0.0) return std::nullopt;
  return kNoise_k * kNoise_k + squares / count;
}

std::optional<double> WeightOf(const PointTexture& texture, const std::vector<PointEpoch>& epochs) {
  const std::optional<double> variance_k2 = VarianceOf(epochs);
  if (!variance_k2) return std::nullopt;
  const double edge_k = kMisalignment_px * texture.mean_slope_k_px;
  return 1.0 / (*variance_k2 + edge_k * edge_k);
}

void AddEpoch(const std::vector<PointSample>& samples, const PointEpoch& epoch,
              const PointTexture& texture, double weight, AlignmentEquations& equations) {
  Eigen::MatrixXd& information = equations.information;
  Eigen::VectorXd mean = Eigen::VectorXd::Zero(information.rows()), by_reflectivity = mean;
  for (std::size_t i = epoch.begin; i < epoch.end; ++i) {
    if (samples[i].held_out) continue;
    const SampleSlope slope(samples[i], texture);
    slope.AddSquare(weight, information);
    slope.AddTo(1.0 / epoch.count, mean);
    slope.AddTo((samples[i].reflectivity - epoch.reflectivity) / epoch.reflectivity_squares,
                by_reflectivity);
  }
  // All slopes are less their mean, and less what goes along with the reflectivity.
  AddSquare(-weight * epoch.count, mean, information);
  AddSquare(-weight * (epoch.reflectivity_squares + MinReflectivitySquares(epoch.count)),
            by_reflectivity, information);
  for (std::size_t i = epoch.begin, end = epoch.begin; i < epoch.end; i = end) {
    const int part = samples[i].part;
    Eigen::VectorXd& gradient = equations.part_gradients[static_cast<std::size_t>(part)];
    double differences = 0.0, with_reflectivity = 0.0;
    for (; end < epoch.end && samples[end].part == part; ++end) {
      if (samples[end].held_out) continue;
      const double difference_k = epoch.Difference(samples[end]);
      SampleSlope(samples[end], texture).AddTo(weight * difference_k, gradient);
      differences += difference_k;
      with_reflectivity += difference_k * (samples[end].reflectivity - epoch.reflectivity);
    }
    gradient -= weight * (differences * mean + with_reflectivity * by_reflectivity);
  }
}

}  // namespace isotherm
