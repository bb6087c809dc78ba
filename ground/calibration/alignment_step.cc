#include "ground/calibration/alignment_step.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>

namespace isotherm {
namespace {

// The images' information over the prior's: half the standard deviation.
constexpr double kMinInformation = 4.0;

/// The equations in units of the prior: all standard deviations are one.
struct Whitened {
  Eigen::MatrixXd information;
  Eigen::VectorXd gradient;
};

/// How many times larger than that of independent samples the variance of the gradient is: its mean
/// over all directions, from the scatter of the parts. Not below one.
double VarianceInflation(const AlignmentEquations& equations, const Eigen::VectorXd& sigma,
                         const Eigen::MatrixXd& information) {
  const Eigen::Index size = sigma.size();
  Eigen::MatrixXd scatter = Eigen::MatrixXd::Zero(size, size);
  double parts = 0.0;
  for (const Eigen::VectorXd& gradient : equations.part_gradients)
    parts += gradient.isZero(0.0) ? 0.0 : 1.0;
  if (parts < 2.0) return 1.0;
  for (const Eigen::VectorXd& gradient : equations.part_gradients) {
    if (gradient.isZero(0.0)) continue;
    const Eigen::VectorXd deviation = sigma.asDiagonal() * (gradient - equations.gradient / parts);
    scatter += deviation * deviation.transpose();
  }
  const Eigen::MatrixXd with_prior = information + Eigen::MatrixXd::Identity(size, size);
  const double inflation = with_prior.ldlt().solve(scatter).trace() * parts / (parts - 1.0);
  return std::max(1.0, inflation / static_cast<double>(size));
}

Whitened Whiten(const AlignmentEquations& equations, const Eigen::VectorXd& sigma) {
  Whitened whitened{sigma.asDiagonal() * equations.information * sigma.asDiagonal(),
                    sigma.asDiagonal() * equations.gradient};
  const double inflation = VarianceInflation(equations, sigma, whitened.information);
  whitened.information /= inflation;
  whitened.gradient /= inflation;
  return whitened;
}

}  // namespace

AlignmentStep SolveAlignment(const AlignmentEquations& equations, const AlignmentPrior& prior,
                             const PlacementVector& correction, const Eigen::VectorXd& drift) {
  const Eigen::Index knots = drift.size();
  Eigen::VectorXd sigma(kPlacementParameters + knots);
  sigma << prior.placement_sigma, prior.drift_sigma;
  const Whitened all = Whiten(equations, sigma);
  // The drift is solved for as a function of the placement (Schur complement).
  PlacementMatrix information =
      all.information.topLeftCorner<kPlacementParameters, kPlacementParameters>();
  PlacementVector gradient = all.gradient.head<kPlacementParameters>();
  Eigen::VectorXd drift_step = Eigen::VectorXd::Zero(knots);
  Eigen::MatrixXd drift_by_placement = Eigen::MatrixXd::Zero(knots, kPlacementParameters);
  if (knots > 0) {
    const Eigen::MatrixXd mixed = all.information.bottomLeftCorner(knots, kPlacementParameters);
    const Eigen::LDLT<Eigen::MatrixXd> solver(all.information.bottomRightCorner(knots, knots) +
                                              Eigen::MatrixXd::Identity(knots, knots));
    drift_step = -solver.solve(all.gradient.tail(knots) + drift.cwiseQuotient(prior.drift_sigma));
    drift_by_placement = -solver.solve(mixed);
    information += mixed.transpose() * drift_by_placement;
    gradient += mixed.transpose() * drift_step;
  }
  const PlacementVector so_far = correction.cwiseQuotient(prior.placement_sigma);
  const Eigen::SelfAdjointEigenSolver<PlacementMatrix> directions(information);
  AlignmentStep step;
  PlacementVector placement = PlacementVector::Zero();
  PlacementMatrix covariance = PlacementMatrix::Zero();
  for (int i = 0; i < kPlacementParameters; ++i) {
    const PlacementVector direction = directions.eigenvectors().col(i);
    const double told = directions.eigenvalues()[i];
    const bool observed = told >= kMinInformation;
    covariance += (observed ? 1.0 / (told + 1.0) : 1.0) * direction * direction.transpose();
    if (!observed) continue;
    ++step.observed_directions;
    placement -= direction.dot(gradient + so_far) / (told + 1.0) * direction;
  }
  step.length = placement.norm();
  placement *= std::min(1.0, 1.0 / std::max(step.length, 1e-12));
  step.placement = prior.placement_sigma.cwiseProduct(placement);
  step.drift = prior.drift_sigma.cwiseProduct(drift_step + drift_by_placement * placement);
  step.covariance =
      prior.placement_sigma.asDiagonal() * covariance * prior.placement_sigma.asDiagonal();
  return step;
}

}  // namespace isotherm
