#include "ground/calibration/alignment_step.h"

#include <gtest/gtest.h>

#include "common/base/noise.h"

namespace isotherm {
namespace {

constexpr int kKnots = 6;
constexpr int kAll = kPlacementParameters + kKnots;

AlignmentPrior UnitPrior(double drift_sigma) {
  return {PlacementVector::Ones(), drift_sigma * Eigen::MatrixXd::Identity(kKnots, kKnots)};
}

/// Equations of a quadratic loss with its minimum at `minimum`, linearised at zero, whose parts
/// scatter as independent samples do: `parts` gradients with the information's own covariance.
AlignmentEquations Quadratic(const Eigen::MatrixXd& information, const Eigen::VectorXd& minimum,
                             double scatter) {
  constexpr int kParts = 400;
  AlignmentEquations equations;
  equations.information = information;
  equations.gradient = -information * minimum;
  const Eigen::MatrixXd root = information.llt().matrixL();
  Eigen::MatrixXd noise(information.rows(), kParts);
  for (Eigen::Index i = 0; i < noise.size(); ++i)
    noise.data()[i] = NormalNoise(NoiseStream(1, 2, 3), static_cast<std::uint64_t>(i));
  noise.colwise() -= noise.rowwise().mean().eval();
  for (int i = 0; i < kParts; ++i) {
    equations.part_gradients.push_back(equations.gradient / kParts +
                                       scatter / std::sqrt(1.0 * kParts) * (root * noise.col(i)));
  }
  return equations;
}

TEST(AlignmentStepTest, MinimumIsWeighedAgainstThePrior) {
  Eigen::VectorXd minimum = Eigen::VectorXd::Zero(kAll);
  minimum[0] = 0.5;
  minimum[4] = -0.25;
  const Eigen::MatrixXd information = 99.0 * Eigen::MatrixXd::Identity(kAll, kAll);
  const AlignmentStep step = SolveAlignment(Quadratic(information, minimum, 1.0), UnitPrior(1.0),
                                            PlacementVector::Zero(), Eigen::VectorXd::Zero(kKnots));
  EXPECT_EQ(step.observed_directions, kPlacementParameters);
  EXPECT_NEAR(step.placement[0], 0.99 * 0.5, 0.003);
  EXPECT_NEAR(step.placement[4], 0.99 * -0.25, 0.003);
  EXPECT_NEAR(step.covariance(0, 0), 0.01, 0.001);
}

TEST(AlignmentStepTest, SamplesThatDependOnEachOtherTellLess) {
  Eigen::VectorXd minimum = Eigen::VectorXd::Zero(kAll);
  const Eigen::MatrixXd information = 10'000.0 * Eigen::MatrixXd::Identity(kAll, kAll);
  const AlignmentStep step = SolveAlignment(Quadratic(information, minimum, 10.0), UnitPrior(1.0),
                                            PlacementVector::Zero(), Eigen::VectorXd::Zero(kKnots));
  EXPECT_NEAR(step.covariance(0, 0), 0.01, 0.002);  // Not 0.0001.
}

TEST(AlignmentStepTest, WhatIsHardlyToldStays) {
  Eigen::VectorXd minimum = Eigen::VectorXd::Constant(kAll, 0.3);
  Eigen::MatrixXd information = 1000.0 * Eigen::MatrixXd::Identity(kAll, kAll);
  information(kRotationY, kRotationY) = 2.0;
  const AlignmentStep step = SolveAlignment(Quadratic(information, minimum, 1.0), UnitPrior(1.0),
                                            PlacementVector::Zero(), Eigen::VectorXd::Zero(kKnots));
  EXPECT_EQ(step.observed_directions, kPlacementParameters - 1);
  EXPECT_NEAR(step.placement[kRotationY], 0.0, 1e-9);
  EXPECT_NEAR(step.placement[kRotationX], 0.3, 0.01);
  EXPECT_NEAR(step.covariance(kRotationY, kRotationY), 1.0, 1e-6);
}

/// A value that only shows together with the drift: what is left for it is its share by the priors.
TEST(AlignmentStepTest, DriftMakesUncertainWhatItCouldPassFor) {
  Eigen::VectorXd together = Eigen::VectorXd::Zero(kAll);
  together[kDelay] = together[kPlacementParameters] = 1.0;
  Eigen::MatrixXd information = 1000.0 * Eigen::MatrixXd::Identity(kAll, kAll);
  information(kDelay, kDelay) = information(kPlacementParameters, kPlacementParameters) = 1e-9;
  information += 1e6 * together * together.transpose();
  Eigen::VectorXd minimum = Eigen::VectorXd::Zero(kAll);
  minimum[kDelay] = 0.4;
  const auto solve = [&](double drift_sigma) {
    return SolveAlignment(Quadratic(information, minimum, 1.0), UnitPrior(drift_sigma),
                          PlacementVector::Zero(), Eigen::VectorXd::Zero(kKnots));
  };
  EXPECT_NEAR(solve(0.001).placement[kDelay], 0.4, 0.001);
  EXPECT_NEAR(std::sqrt(solve(0.1).covariance(kDelay, kDelay)), 0.1, 0.01);
  const AlignmentStep shared = solve(0.1);
  EXPECT_NEAR(shared.placement[kDelay] + shared.drift[0], 0.4, 0.001);
  EXPECT_NEAR(shared.drift[0], 0.4 * 0.01 / 1.01, 0.001);
}

/// A quadratic's minimum does not depend on where it is looked at from.
TEST(AlignmentStepTest, ResultDoesNotDependOnTheWayThere) {
  Eigen::VectorXd minimum = Eigen::VectorXd::Constant(kAll, 0.2);
  const Eigen::MatrixXd information = 99.0 * Eigen::MatrixXd::Identity(kAll, kAll);
  PlacementVector correction = PlacementVector::Zero();
  correction[kDelay] = 0.5;
  const Eigen::VectorXd drift = Eigen::VectorXd::Constant(kKnots, -0.1);
  Eigen::VectorXd at(kAll);
  at << correction, drift;
  const AlignmentStep step =
      SolveAlignment(Quadratic(information, minimum - at, 1.0), UnitPrior(1.0), correction, drift);
  EXPECT_NEAR(correction[kDelay] + step.placement[kDelay], 0.99 * 0.2, 0.003);
  EXPECT_NEAR(correction[kRotationX] + step.placement[kRotationX], 0.99 * 0.2, 0.003);
  EXPECT_NEAR(drift[0] + step.drift[0], 0.99 * 0.2, 0.003);
}

/// Blurred images may move what sharp ones do not tell: it goes back.
TEST(AlignmentStepTest, WhatIsNotToldLeadsBackToThePrior) {
  const Eigen::MatrixXd information = Eigen::MatrixXd::Identity(kAll, kAll);
  PlacementVector correction = PlacementVector::Zero();
  correction[kTranslationX] = 0.7;
  const AlignmentStep step =
      SolveAlignment(Quadratic(information, Eigen::VectorXd::Constant(kAll, 5.0), 1.0),
                     UnitPrior(1.0), correction, Eigen::VectorXd::Zero(kKnots));
  EXPECT_EQ(step.observed_directions, 0);
  EXPECT_NEAR(correction[kTranslationX] + step.placement[kTranslationX], 0.0, 1e-9);
  EXPECT_NEAR(step.placement[kRotationX], 0.0, 1e-9);
}

/// Knots that are all off alike are as likely as one that is: together they may pass for a value
/// that each alone could not.
TEST(AlignmentStepTest, ADriftThatStaysAlikeLeavesMoreUncertain) {
  Eigen::VectorXd together = Eigen::VectorXd::Zero(kAll);
  together[kDelay] = 1.0;
  together.tail<kKnots>().setConstant(1.0 / kKnots);
  const Eigen::MatrixXd information =
      1e8 * together * together.transpose() + 1e-6 * Eigen::MatrixXd::Identity(kAll, kAll);
  const auto sigma = [&](const Eigen::MatrixXd& factor) {
    const AlignmentStep step =
        SolveAlignment(Quadratic(information, Eigen::VectorXd::Zero(kAll), 0.0),
                       {PlacementVector::Ones(), 0.1 * factor}, PlacementVector::Zero(),
                       Eigen::VectorXd::Zero(kKnots));
    return std::sqrt(step.covariance(kDelay, kDelay));
  };
  Eigen::MatrixXd alike = Eigen::MatrixXd::Zero(kKnots, kKnots);
  alike.col(0).setOnes();
  alike.diagonal().tail<kKnots - 1>().setConstant(1e-6);
  EXPECT_NEAR(sigma(Eigen::MatrixXd::Identity(kKnots, kKnots)), 0.1 / std::sqrt(6.0), 0.002);
  EXPECT_NEAR(sigma(alike), 0.1, 0.002);
}

TEST(AlignmentStepTest, PriorOfZeroFixes) {
  AlignmentPrior prior = UnitPrior(0.0);
  prior.placement_sigma[kDelay] = 0.0;
  const Eigen::MatrixXd information = 1000.0 * Eigen::MatrixXd::Identity(kAll, kAll);
  const AlignmentStep step =
      SolveAlignment(Quadratic(information, Eigen::VectorXd::Constant(kAll, 0.2), 1.0), prior,
                     PlacementVector::Zero(), Eigen::VectorXd::Zero(kKnots));
  EXPECT_EQ(step.placement[kDelay], 0.0);
  EXPECT_NEAR(step.placement[kRotationX], 0.2, 0.01);
  EXPECT_TRUE(step.drift.isZero(0.0));
}

}  // namespace
}  // namespace isotherm
