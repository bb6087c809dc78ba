#include "ground/tracker/rig_tracker.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <numbers>

#include "ground/tracker/testing/sub_map.h"

namespace isotherm {
namespace {

using State = RigTracker::State;
using testing::BallInCorner;
using testing::FirstPose;

/// A tracker in front of a sub-map whose surface is exact, frame by frame.
class RigTrackerTest : public testing::SubMapTest {
 protected:
  static constexpr double kMaxError = 0.001;  // Metres: a quarter of a voxel.

  RigTrackerTest() {
    Fill(here_, BallInCorner);
    here_.relocaliser->Add(FirstPose());
    tracker_ = std::make_unique<RigTracker>(options_, camera_);
  }

  void Begin() {
    EXPECT_TRUE(
        tracker_->Begin(Prepare(BallInCorner, TruePose(0)), Time(0), TruePose(0)).tracked());
    LookFrom(TruePose(0));
  }
  void LookFrom(const RigidTransform& T_map_depth) {
    tracker_->LookFrom(T_map_depth, *here_.tsdf, /*is_young=*/false, pool_);
  }
  TrackingResult Track(const PreparedDepth& depth, int i) {
    const TrackingResult result = tracker_->Track(depth, Time(i), here_, here_, pool_);
    if (result.tracked()) LookFrom(result.T_map_depth);
    return result;
  }
  TrackingResult Show(int i) { return Track(Prepare(BallInCorner, TruePose(i)), i); }
  TrackingResult ShowNothing(int i) { return Track(Nothing(), i); }
  /// The surface with waves of 8 mm: within all limits, but not what the model looks like.
  static double Wavy(const Eigen::Vector3d& p) {
    constexpr double kSafe = 0.7;  // It is steeper than a distance.
    const double k = 2.0 * std::numbers::pi / 0.16;
    return kSafe * (BallInCorner(p) + 0.008 * std::sin(k * p.x()) * std::sin(k * p.y()));
  }

  SubMap here_ = MakeSubMap();
  std::unique_ptr<RigTracker> tracker_;
};

TEST_F(RigTrackerTest, FollowsTheRig) {
  Begin();
  for (int i = 1; i < 6; ++i) {
    const TrackingResult result = Show(i);
    ASSERT_TRUE(result.tracked()) << i;
    EXPECT_LT(TranslationDistance(result.T_map_depth, TruePose(i)), kMaxError) << i;
    EXPECT_EQ(tracker_->state(), State::kFollowing);
  }
}

TEST_F(RigTrackerTest, F13IsLostWithoutAViewAndFollowsAgainWhenTwoMoreFramesAgree) {
  Begin();
  Show(1);
  EXPECT_EQ(ShowNothing(2).lost, LostReason::kTooFewPixels);
  EXPECT_EQ(tracker_->state(), State::kLost);
  EXPECT_FALSE(tracker_->motion().last().has_value()) << "nobody knows how it moved meanwhile";
  EXPECT_TRUE(Show(3).tracked());
  EXPECT_EQ(tracker_->state(), State::kConfirming);
  EXPECT_TRUE(Show(4).tracked());
  EXPECT_EQ(tracker_->state(), State::kConfirming);
  EXPECT_EQ(tracker_->relocalisations(), 0U);
  EXPECT_TRUE(Show(5).tracked());
  EXPECT_EQ(tracker_->state(), State::kFollowing);
  EXPECT_EQ(tracker_->relocalisations(), 1U);
}

TEST_F(RigTrackerTest, WhatIsNotConfirmedIsLostAndLookedForWhereTheRigWasLast) {
  Begin();
  const RigidTransform trusted = Show(1).T_map_depth;
  ShowNothing(2);
  ASSERT_TRUE(Show(6).tracked());
  ASSERT_EQ(tracker_->state(), State::kConfirming);
  EXPECT_FALSE(ShowNothing(7).tracked());
  EXPECT_EQ(tracker_->state(), State::kLost);
  EXPECT_EQ(tracker_->relocalisations(), 0U);
  EXPECT_TRUE(tracker_->view().T_map_depth.isApprox(trusted, 1e-12))
      << "where it was found is the wrong place to look back at";
}

TEST_F(RigTrackerTest, WithinAllLimitsButUnlikeTheFramesBeforeIsLost) {
  Begin();
  Show(1);
  EXPECT_TRUE(Track(Prepare(Wavy, TruePose(2)), 2).tracked()) << "what is usual is not known yet";
  tracker_ = std::make_unique<RigTracker>(options_, camera_);
  Begin();
  for (int i = 1; i < 10; ++i) ASSERT_TRUE(Show(i).tracked()) << i;
  const TrackingResult wavy = Track(Prepare(Wavy, TruePose(10)), 10);
  EXPECT_LT(wavy.residual_m, options_.tracker().expert().max_residual_m());
  EXPECT_EQ(wavy.lost, LostReason::kResidual);
}

TEST_F(RigTrackerTest, ASmoothViewIsNotBelievedAfterALossButFollowedBefore) {
  const auto wall = [](const Eigen::Vector3d& p) { return 0.5 - p.z(); };
  here_ = MakeSubMap();
  Fill(here_, wall);
  here_.relocaliser->Add(FirstPose());
  ASSERT_TRUE(tracker_->Begin(Prepare(wall, TruePose(0)), Time(0), TruePose(0)).tracked());
  LookFrom(TruePose(0));
  const TrackingResult before = Track(Prepare(wall, TruePose(1)), 1);
  EXPECT_EQ(before.quality(), TrackingQuality::kDegraded);
  ShowNothing(2);
  for (int i = 3; i < 11; ++i) EXPECT_FALSE(Track(Prepare(wall, TruePose(i)), i).tracked()) << i;
  EXPECT_EQ(tracker_->state(), State::kLost) << "the rig may be anywhere along the wall";
}

TEST_F(RigTrackerTest, WhileLostItIsFoundInAnotherSubMapInThatOnesCoordinates) {
  const Eigen::Vector3d shift(0.04, -0.03, 0.0);
  SubMap other = MakeSubMap();
  Fill(other, [&](const Eigen::Vector3d& p) { return BallInCorner(p - shift); });
  const RigidTransform T_other_here = MakeTransform(shift, Eigen::Quaterniond::Identity());
  other.relocaliser->Add(T_other_here * FirstPose());
  SubMap empty = MakeSubMap();
  tracker_->BeginLost();
  TrackingResult result;
  result.lost = LostReason::kNotFound;
  for (int i = 1; i < 10 && !result.tracked(); ++i) {
    result = tracker_->Track(Prepare(BallInCorner, TruePose(i)), Time(i), empty, other, pool_);
    EXPECT_EQ(tracker_->found_elsewhere(), result.tracked()) << i;
    if (!result.tracked()) continue;
    EXPECT_LT(TranslationDistance(result.T_map_depth, T_other_here * TruePose(i)), kMaxError);
  }
  EXPECT_TRUE(result.tracked());
  EXPECT_EQ(tracker_->state(), State::kConfirming);
}

TEST_F(RigTrackerTest, VerifyingChangesNothing) {
  Begin();
  Show(1);
  const RigidTransform last = tracker_->motion().last()->T_map_depth;
  const RigidTransform view = tracker_->view().T_map_depth;
  const PreparedDepth& depth = Prepare(BallInCorner, TruePose(4));
  const TrackingResult result = tracker_->Verify(depth, TruePose(3), here_, pool_);
  ASSERT_TRUE(result.tracked());
  EXPECT_LT(TranslationDistance(result.T_map_depth, TruePose(4)), kMaxError);
  EXPECT_FALSE(
      tracker_->Verify(Prepare(Wavy, TruePose(4)), TruePose(3), MakeSubMap(), pool_).tracked())
      << "an empty sub-map shows nothing";
  EXPECT_EQ(tracker_->motion().last()->T_map_depth.matrix(), last.matrix());
  EXPECT_EQ(tracker_->view().T_map_depth.matrix(), view.matrix());
  EXPECT_EQ(tracker_->state(), State::kFollowing);
}

TEST_F(RigTrackerTest, InOtherCoordinatesPoseViewAndUncertaintyAreTheSame) {
  Begin();
  for (int i = 1; i < 4; ++i) Show(i);
  const RigidTransform last = tracker_->motion().last()->T_map_depth;
  const Matrix6 covariance = tracker_->uncertainty().covariance();
  // The new x axis is the old y axis.
  const RigidTransform T_new_old = MakeTransform(
      {1.0, 2.0, 3.0},
      Eigen::Quaterniond(Eigen::AngleAxisd(-0.5 * std::numbers::pi, Eigen::Vector3d::UnitZ())));
  tracker_->Rebase(T_new_old);
  constexpr double kRounding = 1e-12;
  EXPECT_TRUE(tracker_->motion().last()->T_map_depth.isApprox(T_new_old * last, kRounding));
  EXPECT_TRUE(tracker_->view().T_map_depth.isApprox(T_new_old * last, kRounding));
  const Matrix6& rebased = tracker_->uncertainty().covariance();
  const int old_axis[6] = {1, 0, 2, 4, 3, 5};
  for (int i = 0; i < 6; ++i) {
    EXPECT_NEAR(rebased(i, i), covariance(old_axis[i], old_axis[i]), kRounding * covariance.norm())
        << i;
  }
}

}  // namespace
}  // namespace isotherm
