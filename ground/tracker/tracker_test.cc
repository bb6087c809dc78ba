#include "ground/tracker/tracker.h"

#include <gtest/gtest.h>

#include <memory>
#include <optional>
#include <vector>

#include "ground/tracker/testing/sub_map.h"

namespace isotherm {
namespace {

using Outcome = TrackedFrame::Outcome;
using testing::BallInCorner;
using testing::FirstPose;

/// A tracker over an atlas whose surfaces are exact, as if frames were integrated into them.
class TrackerTest : public testing::SubMapTest {
 protected:
  static constexpr double kMaxError = 0.001;  // Metres: a quarter of a voxel.
  static constexpr double kLostForLong_s = 0.1;

  TrackerTest() {
    options_.mutable_submaps()->mutable_expert()->set_start_after_lost_s(kLostForLong_s);
    Restart(FirstPose());
  }
  void Restart(std::optional<RigidTransform> initial_pose) {
    tracker_.reset();
    atlas_ = std::make_unique<Atlas>(options_, camera_, Grid());
    tracker_ = std::make_unique<Tracker>(options_, camera_, initial_pose, *atlas_);
  }
  /// Does what the pipeline does with a frame; the surface is there from the first one on.
  TrackedFrame Track(const PreparedDepth& depth, int i) {
    const TrackedFrame frame = tracker_->Track(depth, Time(i), pool_);
    if (frame.outcome == Outcome::kFirst) {
      Fill(atlas_->active(), BallInCorner);
      atlas_->active().anchors = {frame.tracking.T_map_depth};
    }
    if (frame.is_believed()) tracker_->Accept(frame);
    if (frame.outcome != Outcome::kLost) LookFrom(frame.tracking.T_map_depth);
    return frame;
  }
  void LookFrom(const RigidTransform& pose) { tracker_->LookFrom(pose, false, pool_); }
  TrackedFrame Show(int i) { return Track(Prepare(BallInCorner, TruePose(i)), i); }
  TrackedFrame Cover(int i) { return Track(Nothing(), i); }
  /// A surface that fits nothing that was seen before.
  TrackedFrame ShowStrange(int i) {
    const auto wall = [](const Eigen::Vector3d& p) { return 0.4 - p.z(); };
    return Track(Prepare(wall, TruePose(i)), i);
  }
  const std::vector<StampedPose>& poses() const { return tracker_->trajectory().poses(); }

  std::unique_ptr<Atlas> atlas_;
  std::unique_ptr<Tracker> tracker_;
};

TEST_F(TrackerTest, TheFirstPoseIsGivenAndCountsOnceItIsAccepted) {
  const TrackedFrame first = tracker_->Track(Prepare(BallInCorner, TruePose(0)), Time(0), pool_);
  EXPECT_EQ(first.outcome, Outcome::kFirst);
  EXPECT_EQ(first.tracking.T_map_depth.matrix(), FirstPose().matrix());
  EXPECT_TRUE(poses().empty());
  tracker_->Accept(first);
  ASSERT_EQ(poses().size(), 1U);
  EXPECT_EQ(poses()[0].T_world_depth.matrix(), FirstPose().matrix());
}

TEST_F(TrackerTest, AfterAFirstFrameThatLeftNoSurfaceTheNextIsTheFirst) {
  ASSERT_EQ(tracker_->Track(Prepare(BallInCorner, TruePose(0)), Time(0), pool_).outcome,
            Outcome::kFirst);
  tracker_->Reject();
  EXPECT_FALSE(tracker_->motion().last().has_value());
  EXPECT_EQ(Show(1).outcome, Outcome::kFirst);
  EXPECT_EQ(poses().size(), 1U);
}

TEST_F(TrackerTest, CallsInAnotherOrderAreABug) {
  const PreparedDepth depth = Prepare(BallInCorner, TruePose(0));
  const TrackedFrame first = tracker_->Track(depth, Time(0), pool_);
  EXPECT_DEATH(tracker_->Track(depth, Time(1), pool_), "pending_");
  EXPECT_DEATH(LookFrom(FirstPose()), "pending_");
  EXPECT_DEATH(tracker_->CloseLoops(first, depth, {}, pool_), "pending_");
  tracker_->Accept(first);
  EXPECT_DEATH(tracker_->Accept(first), "pending_");
  EXPECT_DEATH(tracker_->Reject(), "pending_");
  EXPECT_DEATH(tracker_->Track(depth, Time(1), pool_), "pending_");
}

TEST_F(TrackerTest, WithoutAPoseTheVolumesCentreLiesOnTheFirstAxis) {
  Restart(std::nullopt);
  const TrackedFrame first = tracker_->Track(Prepare(BallInCorner, TruePose(0)), Time(0), pool_);
  EXPECT_NEAR(first.tracking.T_map_depth.translation().x(), 0.32, 1e-9);
  EXPECT_NEAR(first.tracking.T_map_depth.translation().y(), 0.32, 1e-9);
}

TEST_F(TrackerTest, FramesThatLedToAConfirmationJoinTheTrajectoryWithIt) {
  for (int i = 0; i < 4; ++i) ASSERT_TRUE(Show(i).is_believed()) << i;
  EXPECT_EQ(Cover(4).outcome, Outcome::kLost);
  EXPECT_EQ(Show(5).outcome, Outcome::kUnconfirmed);
  EXPECT_EQ(Show(6).outcome, Outcome::kUnconfirmed);
  EXPECT_EQ(poses().size(), 4U);
  EXPECT_EQ(Show(7).outcome, Outcome::kTracked);
  ASSERT_EQ(poses().size(), 7U);
  for (const int i : {5, 6, 7}) {
    EXPECT_EQ(poses()[i - 1].time, Time(i));
    EXPECT_LT(TranslationDistance(poses()[i - 1].T_world_depth, TruePose(i)), kMaxError) << i;
  }
  EXPECT_EQ(tracker_->trajectory().sigmas().size(), poses().size());
}

TEST_F(TrackerTest, WhatWasNotConfirmedNeverJoinsTheTrajectory) {
  for (int i = 0; i < 4; ++i) Show(i);
  Cover(4);
  ASSERT_EQ(Show(5).outcome, Outcome::kUnconfirmed);
  Cover(6);
  for (int i = 7; i < 10; ++i) Show(i);
  ASSERT_EQ(poses().size(), 7U);
  EXPECT_EQ(poses()[4].time, Time(7));
}

TEST_F(TrackerTest, LostForLongWithSomethingInViewItGoesOnInASubMapOfItsOwn) {
  for (int i = 0; i < 4; ++i) Show(i);
  int i = 4;
  Cover(i++);
  EXPECT_EQ(ShowStrange(i++).outcome, Outcome::kLost) << "not for long yet";
  TrackedFrame frame;
  while (i < 20 && frame.outcome == Outcome::kLost) {
    EXPECT_FALSE(frame.switched);
    frame = ShowStrange(i++);
  }
  EXPECT_EQ(frame.outcome, Outcome::kFirst);
  EXPECT_TRUE(frame.switched);
  EXPECT_GE(ToSeconds(frame.time - Time(4)), kLostForLong_s);
  EXPECT_EQ(atlas_->size(), 2);
  EXPECT_EQ(atlas_->active_index(), 1);
  EXPECT_EQ(poses().size(), 4U) << "where that is in the world is not known";
}

TEST_F(TrackerTest, ACoveredCameraBeginsNoSubMap) {
  for (int i = 0; i < 4; ++i) Show(i);
  for (int i = 4; i < 20; ++i) EXPECT_EQ(Cover(i).outcome, Outcome::kLost);
  EXPECT_EQ(atlas_->size(), 1);
}

TEST_F(TrackerTest, ALostRigIsLookedForInAllSubMapsInTurn) {
  Fill(atlas_->active(), [](const Eigen::Vector3d& p) { return 0.4 - p.z(); });
  ASSERT_TRUE(atlas_->BeginElsewhere());
  Fill(atlas_->active(), BallInCorner);
  atlas_->active().relocaliser->Add(FirstPose());
  atlas_->Activate(0);
  LookFrom(FirstPose());
  tracker_->BeginLost();
  TrackedFrame frame;
  for (int i = 4; i < 12 && frame.outcome == Outcome::kLost; ++i) frame = Show(i);
  EXPECT_EQ(frame.outcome, Outcome::kUnconfirmed);
  EXPECT_TRUE(frame.switched);
  EXPECT_EQ(atlas_->active_index(), 1);
}

TEST_F(TrackerTest, AFrameThatIsIntegratedBecomesAKnownView) {
  Show(0);
  const PreparedDepth& depth = Prepare(BallInCorner, TruePose(1));
  const TrackedFrame frame = tracker_->Track(depth, Time(1), pool_);
  tracker_->Accept(frame);
  const std::size_t known = atlas_->active().relocaliser->keyframes().poses().size();
  EXPECT_FALSE(tracker_->CloseLoops(frame, depth, {}, pool_));
  EXPECT_EQ(atlas_->active().relocaliser->keyframes().poses().size(), known + 1);
}

TEST_F(TrackerTest, TimeIsSpentOnTrackingOrOnSearching) {
  Show(0);
  EXPECT_EQ(tracker_->times().track.count(), 0U) << "the first pose is given";
  Show(1);
  Cover(2);
  Show(3);
  EXPECT_EQ(tracker_->times().track.count(), 2U);
  EXPECT_EQ(tracker_->times().relocalise.count(), 1U);
}

}  // namespace
}  // namespace isotherm
