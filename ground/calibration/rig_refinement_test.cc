#include "ground/calibration/rig_refinement.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <cmath>
#include <cstdio>
#include <functional>
#include <numbers>
#include <stop_token>

#include "common/base/noise.h"
#include "ground/calibration/testing/wall_scan.h"

namespace isotherm {
namespace {

using ::testing::HasSubstr;
using testing::Look;
using testing::ScanOf;
using testing::TruePlacement;
using testing::WallScan;

constexpr double kDegree = std::numbers::pi / 180.0;

Result<Refinement> RefineWall(const WallScan& scan, const PlacementVector& off_by,
                              const RefinementPrior& prior = {}) {
  ScanViews views = ScanOf(scan);
  ThreadPool pool(2);
  const LookAgain look_again = [&](const ThermalPlacement& placement, double,
                                   const std::function<void(double)>&) {
    return Look(views, placement);
  };
  return RefinePlacement(views, Corrected(TruePlacement(), off_by), prior, look_again, pool, {});
}

PlacementVector SomewhatOff(std::uint64_t seed) {
  PlacementVector off_by;
  for (int i = 0; i < kPlacementParameters; ++i)
    off_by[i] = NormalNoise(seed, static_cast<std::uint64_t>(i));
  off_by.head<3>() *= 0.7 * kDegree / off_by.head<3>().norm();
  off_by.segment<3>(3) *= 0.006 / off_by.segment<3>(3).norm();
  off_by[kDelay] = off_by[kDelay] < 0.0 ? -0.012 : 0.012;
  off_by.segment<2>(kPrincipalX) *= 3.0 / off_by.segment<2>(kPrincipalX).norm();
  off_by.tail<2>().setZero();
  return off_by;
}

/// The error that is left, in standard deviations as they are told.
PlacementVector Errors(const Refinement& refinement) {
  PlacementVector errors = CorrectionBetween(TruePlacement(), refinement.after);
  for (int i = 0; i < kPlacementParameters; ++i)
    errors[i] /= refinement.Sigma(static_cast<PlacementParameter>(i));
  return errors;
}

TEST(RigRefinementTest, PlacementIsFoundAgain) {
  double squares = 0.0;
  for (const std::uint64_t seed : {1, 2}) {
    const Result<Refinement> refined = RefineWall({.seed = seed}, SomewhatOff(seed));
    ASSERT_TRUE(refined.has_value()) << refined.error().message();
    const PlacementVector left = CorrectionBetween(TruePlacement(), refined->after);
    std::printf("seed %d: off by %.1f px, then %.3f degrees, %.2f mm, %.2f ms, %.2f px\n",
                static_cast<int>(seed), refined->shift.rms_px, left.head<3>().norm() / kDegree,
                1e3 * left.segment<3>(3).norm(), 1e3 * left[kDelay],
                left.segment<2>(kPrincipalX).norm());
    EXPECT_LT(left.head<3>().norm(), 0.1 * kDegree);
    EXPECT_LT(left.segment<3>(3).norm(), 0.001);
    EXPECT_LT(std::abs(left[kDelay]), 0.0005);
    EXPECT_LT(left.segment<2>(kPrincipalX).norm(), 0.3);
    // The wall's contrast is low, so that the scene's influence is hardly told.
    EXPECT_LT(left.tail<2>().norm(), 0.02);
    EXPECT_GE(refined->observed_directions, kPlacementParameters - 2);
    for (int i = 0; i < kNearInfluence; ++i)
      EXPECT_TRUE(refined->Tells(static_cast<PlacementParameter>(i)));
    EXPECT_GT(refined->shift.rms_px, 1.0);
    EXPECT_LT(refined->held_out.after_k, 0.5 * refined->held_out.before_k);
    squares += Errors(*refined).squaredNorm() / (2.0 * kPlacementParameters);
  }
  // Uncertainties are neither too small nor an excuse.
  EXPECT_LT(std::sqrt(squares), 2.0);
  EXPECT_GT(std::sqrt(squares), 0.2);
}

TEST(RigRefinementTest, WhoIsToldToStopLooksNoFurther) {
  for (const int at_look : {0, 1, 3}) {
    ScanViews views = ScanOf({.seed = 1});
    ThreadPool pool(2);
    std::stop_source stop;
    int looks = 0, reports_after = 0;
    const LookAgain look_again = [&](const ThermalPlacement& placement, double,
                                     const std::function<void(double)>&) {
      if (++looks == at_look) stop.request_stop();
      return Look(views, placement);
    };
    if (at_look == 0) stop.request_stop();
    const Result<Refinement> refined = RefinePlacement(
        views, TruePlacement(), {}, look_again, pool,
        [&](double) { reports_after += stop.stop_requested() ? 1 : 0; }, stop.get_token());
    ASSERT_FALSE(refined);
    EXPECT_EQ(refined.error().message(), "told to stop");
    EXPECT_EQ(looks, at_look);
    EXPECT_EQ(reports_after, 0) << "nothing was compared";
  }
}

/// Without its two parameters the pose is 2.9 pixels off.
TEST(RigRefinementTest, InfluenceOfTheSceneIsFoundToo) {
  const Result<Refinement> refined = RefineWall(
      {.contrast_k = 40.0, .near_fraction = 0.05, .total_fraction = 0.03}, PlacementVector::Zero());
  ASSERT_TRUE(refined.has_value()) << refined.error().message();
  const SceneInfluence& found = refined->after.influence;
  const double near_sigma = refined->Sigma(kNearInfluence);
  const double total_sigma = refined->Sigma(kTotalInfluence);
  std::printf("shift %.3f px, near %.4f (%.4f), total %.4f (%.4f)\n", refined->shift.rms_px,
              found.near_fraction, near_sigma, found.total_fraction, total_sigma);
  EXPECT_NEAR(found.near_fraction, 0.05, std::max(0.008, 3.0 * near_sigma));
  EXPECT_NEAR(found.total_fraction, 0.03, 3.0 * total_sigma);
  EXPECT_LT(near_sigma, 0.01);
  EXPECT_LT(total_sigma, 0.02);
  EXPECT_LT(refined->shift.rms_px, 0.15);
}

/// In half a frame's time from the middle row to the last, points move by up to two pixels.
TEST(RigRefinementTest, RowsThatAreReadLaterAreNoDelay) {
  const WallScan scan = {.row_readout_s = 0.0002};
  const Result<Refinement> refined = RefineWall(scan, PlacementVector::Zero());
  ASSERT_TRUE(refined.has_value()) << refined.error().message();
  std::printf("shift %.3f px, delay %.2f ms\n", refined->shift.rms_px,
              1e3 * refined->correction[kDelay]);
  EXPECT_LT(refined->shift.rms_px, 0.15);
  EXPECT_NEAR(refined->correction[kDelay], 0.0, 0.0003);
}

TEST(RigRefinementTest, RightPlacementStays) {
  const Result<Refinement> refined = RefineWall({}, PlacementVector::Zero());
  ASSERT_TRUE(refined.has_value()) << refined.error().message();
  EXPECT_LT(refined->shift.rms_px, std::max(0.05, 3.0 * refined->shift.sigma_px));
  EXPECT_LT(refined->shift.sigma_px, 0.2);
  EXPECT_NEAR(refined->held_out.after_k, refined->held_out.before_k,
              0.05 * refined->held_out.before_k);
}

TEST(RigRefinementTest, OffsetAfterANucIsNoTexture) {
  const Result<Refinement> refined = RefineWall({.nuc_offset_k = 3.0}, SomewhatOff(4));
  ASSERT_TRUE(refined.has_value()) << refined.error().message();
  EXPECT_LT(Errors(*refined).cwiseAbs().maxCoeff(), 4.0);
  EXPECT_LT(refined->held_out.after_k, 0.3);
}

TEST(RigRefinementTest, WanderingPosesAreInTheUncertainty) {
  double squares = 0.0;
  for (const std::uint64_t seed : {1, 2, 3}) {
    const Result<Refinement> refined =
        RefineWall({.seed = seed, .drift_m = 0.0003}, SomewhatOff(seed));
    ASSERT_TRUE(refined.has_value()) << refined.error().message();
    squares += Errors(*refined).squaredNorm() / (3.0 * kPlacementParameters);
  }
  std::printf("errors over uncertainty, root mean square: %.2f\n", std::sqrt(squares));
  EXPECT_LT(std::sqrt(squares), 2.0);
  EXPECT_GT(std::sqrt(squares), 0.3);
}

TEST(RigRefinementTest, EvenlyWarmWallTellsNothing) {
  const Result<Refinement> refined = RefineWall({.contrast_k = 0.0}, SomewhatOff(1));
  ASSERT_FALSE(refined.has_value());
  EXPECT_THAT(refined.error().message(), HasSubstr("warm and cold parts"));
}

TEST(RigRefinementTest, RestingRigChangesNothing) {
  const Result<Refinement> refined = RefineWall({.motion = 0.0}, SomewhatOff(1));
  ASSERT_TRUE(refined.has_value()) << refined.error().message();
  EXPECT_EQ(refined->observed_directions, 0);
  EXPECT_TRUE(refined->correction.isZero(1e-9));
  EXPECT_FALSE(refined->Tells(kRotationX));
}

TEST(RigRefinementTest, WhatIsToBeKeptIsKept) {
  PlacementVector off_by = SomewhatOff(3);
  off_by.segment<2>(kPrincipalX).setZero();
  const Result<Refinement> refined = RefineWall({}, off_by, {.principal_point_px = 0.0});
  ASSERT_TRUE(refined.has_value()) << refined.error().message();
  EXPECT_EQ(refined->correction[kPrincipalX], 0.0);
  EXPECT_TRUE(refined->Keeps(kPrincipalY));
  EXPECT_FALSE(refined->Keeps(kDelay));
  const PlacementVector left = CorrectionBetween(TruePlacement(), refined->after);
  EXPECT_LT(left.head<3>().norm(), 0.05 * kDegree);
  EXPECT_LT(left.segment<3>(3).norm(), 0.001);
  const Result<Refinement> delay_only =
      RefineWall({}, PlacementVector::Unit(kDelay) * 0.01,
                 {.rotation_rad = 0.0, .translation_m = 0.0, .principal_point_px = 0.0});
  ASSERT_TRUE(delay_only.has_value()) << delay_only.error().message();
  EXPECT_NEAR(delay_only->correction[kDelay], -0.01, 0.0003);
  EXPECT_TRUE(delay_only->correction.head<6>().isZero(1e-12));
}

/// Hot, and seen at changing angles: what the emission angle does must not pass for a texture.
TEST(RigRefinementTest, EmissionAngleIsNoTexture) {
  const Result<Refinement> refined =
      RefineWall({.fold = 0.8, .refractive_index = 1.4}, PlacementVector::Zero());
  ASSERT_TRUE(refined.has_value()) << refined.error().message();
  std::printf("shift %.3f px\n", refined->shift.rms_px);
  EXPECT_LT(refined->shift.rms_px, 0.2);
}

/// A texture that is shifted on a flat wall agrees with itself as well as in its place, as long as
/// the rig never turns.
TEST(RigRefinementTest, SweepAlongAFlatWallKeepsWhatItCannotTell) {
  const PlacementVector off_by = SomewhatOff(2);
  const Result<Refinement> refined = RefineWall({.fold = 0.0, .turns = false}, off_by);
  ASSERT_TRUE(refined.has_value()) << refined.error().message();
  EXPECT_LT(refined->observed_directions, kPlacementParameters);
  EXPECT_FALSE(refined->Tells(kTranslationX));
  EXPECT_FALSE(refined->Tells(kTranslationY));
  // Along what is not told, nothing has moved.
  const PlacementVector in_priors = refined->correction.cwiseQuotient(refined->prior_sigma);
  const PlacementMatrix covariance = refined->prior_sigma.cwiseInverse().asDiagonal() *
                                     refined->covariance *
                                     refined->prior_sigma.cwiseInverse().asDiagonal();
  const Eigen::SelfAdjointEigenSolver<PlacementMatrix> axes(covariance);
  for (int i = 0; i < kPlacementParameters; ++i) {
    if (axes.eigenvalues()[i] < 0.9) continue;
    EXPECT_NEAR(axes.eigenvectors().col(i).dot(in_priors), 0.0, 0.02) << "direction " << i;
  }
  // The delay is told by the swing.
  EXPECT_TRUE(refined->Tells(kDelay));
  EXPECT_NEAR(refined->correction[kDelay], -off_by[kDelay], 0.001);
}

}  // namespace
}  // namespace isotherm
