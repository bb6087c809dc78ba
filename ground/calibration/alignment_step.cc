#include "ground/calibration/alignment_step.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <vector>

namespace isotherm {
namespace {

// The images' information over the prior's: half the standard deviation.
constexpr double kMinInformation = 4.0;

/// In units of the prior; what has none is fixed, and has not moved.
Eigen::VectorXd Standardized(const Eigen::VectorXd& values, const Eigen::VectorXd& sigma) {
  return (sigma.array() > 0.0).select(values.array() / sigma.array().max(1e-300), 0.0);
}

/// The equations of a placement in units of the prior, with the drift that suits each placement
/// best (Schur complement): `drift` = drift_at_rest + drift_by_placement * placement.
struct Reduced {
  PlacementMatrix information;
  PlacementVector gradient;
  Eigen::VectorXd drift_at_rest;
  Eigen::MatrixXd drift_by_placement;
};

/// `information` and `gradient` are divided by `inflation`.
Reduced Reduce(const Eigen::MatrixXd& information, const Eigen::VectorXd& gradient,
               const Eigen::VectorXd& drift, double inflation) {
  const Eigen::Index knots = drift.size();
  Reduced reduced;
  reduced.information =
      information.topLeftCorner<kPlacementParameters, kPlacementParameters>() / inflation;
  reduced.gradient = gradient.head<kPlacementParameters>() / inflation;
  reduced.drift_at_rest = Eigen::VectorXd::Zero(knots);
  reduced.drift_by_placement = Eigen::MatrixXd::Zero(knots, kPlacementParameters);
  if (knots == 0) return reduced;
  const Eigen::MatrixXd mixed =
      information.bottomLeftCorner(knots, kPlacementParameters) / inflation;
  const Eigen::LDLT<Eigen::MatrixXd> solver(information.bottomRightCorner(knots, knots) /
                                                inflation +
                                            Eigen::MatrixXd::Identity(knots, knots));
  reduced.drift_at_rest = -solver.solve(gradient.tail(knots) / inflation + drift);
  reduced.drift_by_placement = -solver.solve(mixed);
  reduced.information += mixed.transpose() * reduced.drift_by_placement;
  reduced.gradient += mixed.transpose() * reduced.drift_at_rest;
  return reduced;
}

/// How many times larger than that of independent samples the variance of the placement's gradient
/// is, the drift aside: the mean over the directions that are told, from the scatter of the parts.
/// Not below one. `to_units` are the prior's, as in Reduced.
double VarianceInflation(const AlignmentEquations& equations, const Eigen::MatrixXd& to_units,
                         const Reduced& reduced) {
  std::vector<PlacementVector> parts;
  PlacementVector mean = PlacementVector::Zero();
  for (const Eigen::VectorXd& gradient : equations.part_gradients) {
    if (gradient.isZero(0.0)) continue;
    const Eigen::VectorXd whitened = to_units.transpose() * gradient;
    parts.push_back(whitened.head<kPlacementParameters>() +
                    reduced.drift_by_placement.transpose() *
                        whitened.tail(reduced.drift_at_rest.size()));
    mean += parts.back();
  }
  if (parts.size() < 2) return 1.0;
  const auto count = static_cast<double>(parts.size());
  mean /= count;
  PlacementMatrix scatter = PlacementMatrix::Zero();
  for (const PlacementVector& part : parts)
    scatter += (part - mean) * (part - mean).transpose() * count / (count - 1.0);
  const Eigen::SelfAdjointEigenSolver<PlacementMatrix> directions(reduced.information);
  double ratios = 0.0, told = 0.0;
  for (int i = 0; i < kPlacementParameters; ++i) {
    if (directions.eigenvalues()[i] < kMinInformation) continue;
    const PlacementVector direction = directions.eigenvectors().col(i);
    ratios += direction.dot(scatter * direction) / directions.eigenvalues()[i];
    told += 1.0;
  }
  return told > 0.0 ? std::max(1.0, ratios / told) : 1.0;
}

}  // namespace

AlignmentStep SolveAlignment(const AlignmentEquations& equations, const AlignmentPrior& prior,
                             const PlacementVector& correction, const Eigen::VectorXd& drift) {
  const Eigen::Index size = kPlacementParameters + drift.size();
  Eigen::MatrixXd to_units = Eigen::MatrixXd::Zero(size, size);
  to_units.diagonal().head<kPlacementParameters>() = prior.placement_sigma;
  to_units.bottomRightCorner(drift.size(), drift.size()) = prior.drift_factor;
  const Eigen::MatrixXd information = to_units.transpose() * equations.information * to_units;
  const Eigen::VectorXd gradient = to_units.transpose() * equations.gradient;
  const Eigen::VectorXd drift_so_far =
      drift.isZero(0.0) ? drift : prior.drift_factor.triangularView<Eigen::Lower>().solve(drift);
  const double inflation =
      VarianceInflation(equations, to_units, Reduce(information, gradient, drift_so_far, 1.0));
  const Reduced reduced = Reduce(information, gradient, drift_so_far, inflation);
  const PlacementVector so_far = Standardized(correction, prior.placement_sigma);
  const Eigen::SelfAdjointEigenSolver<PlacementMatrix> directions(reduced.information);
  AlignmentStep step;
  PlacementVector placement = PlacementVector::Zero();
  PlacementMatrix covariance = PlacementMatrix::Zero();
  for (int i = 0; i < kPlacementParameters; ++i) {
    const PlacementVector direction = directions.eigenvectors().col(i);
    const double told = directions.eigenvalues()[i];
    const bool observed = told >= kMinInformation;
    // Along the others, back to where the prior is.
    const double sigma = observed ? 1.0 / std::sqrt(told + 1.0) : 1.0;
    const double by =
        observed ? direction.dot(reduced.gradient + so_far) * sigma * sigma : direction.dot(so_far);
    placement -= by * direction;
    covariance += sigma * sigma * direction * direction.transpose();
    step.in_sigmas = std::hypot(step.in_sigmas, by / sigma);
    step.observed_directions += observed ? 1 : 0;
  }
  step.length = placement.norm();
  placement *= std::min(1.0, 1.0 / std::max(step.length, 1e-12));
  step.placement = prior.placement_sigma.cwiseProduct(placement);
  step.drift =
      prior.drift_factor * (reduced.drift_at_rest + reduced.drift_by_placement * placement);
  step.covariance =
      prior.placement_sigma.asDiagonal() * covariance * prior.placement_sigma.asDiagonal();
  return step;
}

}  // namespace isotherm
