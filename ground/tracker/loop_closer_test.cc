#include "ground/tracker/loop_closer.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <string>

#include "ground/tracker/testing/sub_map.h"

namespace isotherm {
namespace {

using testing::BallInCorner;
using testing::FirstPose;

constexpr int kLookEvery = 10;  ///< Frames between two looks at other sub-maps.

/// A rig that is followed in a sub-map which has no place yet, before a surface that the first
/// sub-map knows too, shifted.
class LoopCloserTest : public testing::SubMapTest {
 protected:
  LoopCloserTest() {
    options_.mutable_submaps()->mutable_expert()->set_max_travel_m(0.5);
    atlas_ = std::make_unique<Atlas>(options_, camera_, Grid());
    tracker_ = std::make_unique<RigTracker>(options_, camera_);
    closer_ = std::make_unique<LoopCloser>(options_, *atlas_, *tracker_);
    Fill(atlas_->active(), BallInCorner);
    atlas_->active().relocaliser->Add(FirstPose());
    atlas_->active().anchors = {FirstPose()};
  }
  void BeginElsewhere() {
    ASSERT_TRUE(atlas_->BeginElsewhere());
    const RigidTransform& T_world_map = kWorldFromMap;
    Fill(atlas_->active(), [&](const auto& p) { return BallInCorner(T_world_map * p); });
    atlas_->active().relocaliser->Add(InMap(FirstPose()));
    atlas_->active().anchors = {InMap(FirstPose())};
  }
  static RigidTransform InMap(const RigidTransform& T_world_depth) {
    return kWorldFromMap.inverse() * T_world_depth;
  }
  /// One frame of a rig that is at `T_map_depth`, as the tracker believes.
  LoopCloser::Change Update(const PreparedDepth& depth, const RigidTransform& T_map_depth) {
    return closer_->Update(depth, T_map_depth, {}, pool_);
  }
  /// Frames until another sub-map is looked at. The rig is at TruePose(at); the tracker is off by
  /// `error_m`.
  LoopCloser::Change UntilLook(int at, double error_m = 0.0) {
    RigidTransform T_map_depth = InMap(TruePose(at));
    T_map_depth.translation().x() += error_m;
    const PreparedDepth& depth = Prepare(BallInCorner, TruePose(at));
    LoopCloser::Change change;
    for (int i = 0; i < kLookEvery; ++i) {
      EXPECT_FALSE(change.linked) << "between two looks";
      change = Update(depth, T_map_depth);
    }
    return change;
  }

  static inline const RigidTransform kWorldFromMap =
      MakeTransform({0.03, -0.02, 0.0}, Eigen::Quaterniond::Identity());
  std::unique_ptr<Atlas> atlas_;
  std::unique_ptr<RigTracker> tracker_;
  std::unique_ptr<LoopCloser> closer_;
};

TEST_F(LoopCloserTest, OneSightingIsNotBelieved) {
  BeginElsewhere();
  EXPECT_FALSE(UntilLook(0).linked);
  EXPECT_FALSE(atlas_->IsLinked(0, 1));
  EXPECT_FALSE(atlas_->active().joined);
}

TEST_F(LoopCloserTest, TwoSightingsThatAgreeJoinTheSubMapsWhereTheyAre) {
  constexpr double kMaxError = 0.001;  // Metres: a quarter of a voxel.
  BeginElsewhere();
  UntilLook(0);
  EXPECT_TRUE(UntilLook(2).linked);
  EXPECT_TRUE(atlas_->IsLinked(0, 1));
  ASSERT_TRUE(atlas_->active().joined);
  EXPECT_LT(TranslationDistance(atlas_->active().T_world_map, kWorldFromMap), kMaxError);
  EXPECT_FALSE(UntilLook(4).linked) << "they are linked already";
}

TEST_F(LoopCloserTest, SightingsThatContradictEachOtherAreNotBelievedUntilTwoInARowAgree) {
  constexpr double kOff = 0.015;  // Metres: more than sightings may differ by.
  BeginElsewhere();
  UntilLook(0);
  EXPECT_FALSE(UntilLook(2, kOff).linked);
  EXPECT_FALSE(UntilLook(4, 0.0).linked);
  EXPECT_TRUE(UntilLook(6, 0.0).linked);
}

TEST_F(LoopCloserTest, ALookInVainForgetsTheSightingBefore) {
  BeginElsewhere();
  UntilLook(0);
  const PreparedDepth& nothing = Nothing();
  for (int i = 0; i < kLookEvery; ++i) Update(nothing, InMap(TruePose(1)));
  EXPECT_FALSE(UntilLook(2).linked) << "the first of two again";
  EXPECT_TRUE(UntilLook(4).linked);
}

TEST_F(LoopCloserTest, FarFromWhereItBeganASubMapEndsAndTheNextOneBegins) {
  RigidTransform far = FirstPose();
  far.translation().x() += 0.6;
  const PreparedDepth& depth = Prepare(BallInCorner, FirstPose());
  EXPECT_FALSE(Update(depth, FirstPose()).switched);
  EXPECT_TRUE(Update(depth, far).switched);
  EXPECT_EQ(atlas_->size(), 2);
  EXPECT_EQ(atlas_->active_index(), 1);
}

TEST_F(LoopCloserTest, WhereALinkedSubMapShowsWhatIsInViewTheRigGoesBackToIt) {
  constexpr double kMaxError = 0.001;
  BeginElsewhere();
  UntilLook(0);
  ASSERT_TRUE(UntilLook(2).linked);
  atlas_->active().anchors = {InMap(FirstPose()) *
                              MakeTransform({0.6, 0.0, 0.0}, Eigen::Quaterniond::Identity())};
  tracker_->Begin(Prepare(BallInCorner, TruePose(3)), Time(3), InMap(TruePose(3)));
  EXPECT_TRUE(Update(Prepare(BallInCorner, TruePose(3)), InMap(TruePose(3))).switched);
  EXPECT_EQ(atlas_->active_index(), 0);
  EXPECT_EQ(atlas_->size(), 2);
  EXPECT_LT(TranslationDistance(tracker_->motion().last()->T_map_depth, TruePose(3)), kMaxError)
      << "the tracker has followed";
}

TEST_F(LoopCloserTest, WithoutRoomForAnotherTheScanGoesOnInTheLastOne) {
  options_.mutable_submaps()->mutable_expert()->set_max_maps(1);
  Atlas atlas(options_, camera_, Grid());
  atlas.active().anchors = {FirstPose()};
  LoopCloser closer(options_, atlas, *tracker_);
  RigidTransform far = FirstPose();
  far.translation().x() += 0.6;
  const PreparedDepth& depth = Prepare(BallInCorner, FirstPose());
  ::testing::internal::CaptureStderr();
  for (int i = 0; i < 3; ++i) EXPECT_FALSE(closer.Update(depth, far, {}, pool_).switched);
  const std::string log = ::testing::internal::GetCapturedStderr();
  EXPECT_EQ(std::ranges::count(log, '\n'), 1) << "said once: " << log;
  EXPECT_NE(log.find("no sub-map can be begun"), std::string::npos) << log;
}

}  // namespace
}  // namespace isotherm
