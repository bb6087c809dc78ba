#include "ground/console/group_schedule.h"

#include <gtest/gtest.h>

#include <set>

namespace isotherm {
namespace {

using namespace std::chrono_literals;

const Eigen::Vector3i kBlocks(40, 40, 40);

class GroupScheduleTest : public ::testing::Test {
 protected:
  /// A block in the middle of group (x, 0, 0): it touches no other.
  void NoteGroup(int x, int map = 0, CaptureTime time = {}) {
    schedule_.NoteBlock(map, {4 * x + 1, 1, 1}, kBlocks, time);
  }
  int TakeX(SteadyTime now, const Eigen::Vector3d& rig = Eigen::Vector3d::Zero()) {
    const auto due = schedule_.Take(now, 0, rig);
    if (!due) return -1;
    schedule_.SetShown(due->key, true);
    return due->key.x;
  }
  const SteadyTime start_{1h};
  GroupSchedule schedule_{1s};
};

TEST_F(GroupScheduleTest, NothingChangedIsNothingToDo) {
  EXPECT_EQ(TakeX(start_), -1);
  EXPECT_EQ(schedule_.waiting(), 0U);
}

TEST_F(GroupScheduleTest, TheNearestNewGroupIsMadeFirst) {
  for (const int x : {1, 7, 4}) NoteGroup(x);
  const Eigen::Vector3d rig(4.9, 0.5, 0.5);
  EXPECT_EQ(TakeX(start_, rig), 4);
  EXPECT_EQ(TakeX(start_, rig), 7);
  EXPECT_EQ(TakeX(start_, rig), 1);
  EXPECT_EQ(TakeX(start_, rig), -1);
}

TEST_F(GroupScheduleTest, AGroupIsMadeAgainNoSoonerThanItsInterval) {
  NoteGroup(1);
  EXPECT_EQ(TakeX(start_), 1);
  NoteGroup(1);
  EXPECT_EQ(TakeX(start_ + 500ms), -1);
  EXPECT_EQ(schedule_.waiting(), 1U);
  EXPECT_EQ(TakeX(start_ + 1s), 1);
}

TEST_F(GroupScheduleTest, AGroupIsAsOldAsItsFirstChange) {
  const CaptureTime first = CaptureTimeFromNanoseconds(5), later = CaptureTimeFromNanoseconds(9);
  NoteGroup(1, 0, first);
  NoteGroup(1, 0, later);
  EXPECT_EQ(schedule_.Take(start_, 0, Eigen::Vector3d::Zero())->changed, first);
  NoteGroup(1, 0, later);
  EXPECT_EQ(schedule_.Take(start_ + 1s, 0, Eigen::Vector3d::Zero())->changed, later);
}

TEST_F(GroupScheduleTest, NewSurfaceComesBeforeBetterSurface) {
  NoteGroup(0);
  EXPECT_EQ(TakeX(start_), 0);
  NoteGroup(0);
  NoteGroup(9);
  EXPECT_EQ(TakeX(start_ + 5s), 9);
  EXPECT_EQ(TakeX(start_ + 5s), 0);
}

TEST_F(GroupScheduleTest, TheFirstSurfaceOfAPlaceComesBeforeAll) {
  for (const int x : {0, 9}) NoteGroup(x);
  EXPECT_EQ(TakeX(start_), 0);
  EXPECT_TRUE(schedule_.Take(start_, 0, Eigen::Vector3d::Zero())->is_new) << "9 shows nothing";
  for (const int x : {0, 9}) NoteGroup(x);
  EXPECT_EQ(TakeX(start_ + 50ms), -1) << "nothing is looked at all the time";
  EXPECT_EQ(TakeX(start_ + 5s), 9);
  EXPECT_EQ(TakeX(start_ + 5s), 0);
  NoteGroup(9);
  EXPECT_FALSE(schedule_.Take(start_ + 6s, 0, Eigen::Vector3d::Zero())->is_new);
}

TEST_F(GroupScheduleTest, WhenNothingIsToBeRefreshedNewSurfaceStillComes) {
  NoteGroup(0);
  EXPECT_EQ(TakeX(start_), 0);
  for (const int x : {0, 9}) NoteGroup(x);
  const auto take = [&] {
    return schedule_.Take(start_ + 5s, 0, Eigen::Vector3d::Zero(), /*may_refresh=*/false);
  };
  EXPECT_EQ(take()->key.x, 9);
  EXPECT_FALSE(take());
  EXPECT_EQ(TakeX(start_ + 5s), 0);
}

TEST_F(GroupScheduleTest, WhatStaysEmptyIsLookedAtLessAndLess) {
  int looks = 0;
  for (int i = 0; i < 100; ++i) {
    NoteGroup(1);
    const auto due = schedule_.Take(start_ + i * 100ms, 0, Eigen::Vector3d::Zero());
    if (!due) continue;
    ++looks;
    schedule_.SetShown(due->key, false);
  }
  // After 0.1, 0.1, 0.2, 0.4, 0.8 and then each second.
  EXPECT_EQ(looks, 14);
}

TEST_F(GroupScheduleTest, FarGroupsGetTheirTurn) {
  for (const int x : {0, 9}) NoteGroup(x);
  TakeX(start_);
  TakeX(start_);
  std::set<int> made;
  for (SteadyTime now = start_; now < start_ + 30s; now += 1s) {  // Time for one each second.
    for (const int x : {0, 9}) NoteGroup(x);
    made.insert(TakeX(now));
  }
  EXPECT_TRUE(made.contains(9));
}

TEST_F(GroupScheduleTest, ABlockAtABorderChangesTheGroupsBesideIt) {
  schedule_.NoteBlock(0, {4, 4, 4}, kBlocks, {});
  EXPECT_EQ(schedule_.waiting(), 8U);
  schedule_.Clear();
  // At the volume's border there is nobody beside it.
  schedule_.NoteBlock(0, {0, 1, 1}, kBlocks, {});
  EXPECT_EQ(schedule_.waiting(), 1U);
}

TEST_F(GroupScheduleTest, WhatIsInTheActiveSubMapComesFirst) {
  NoteGroup(0, 1);
  NoteGroup(9, 0);
  const auto first = schedule_.Take(start_, 0, Eigen::Vector3d::Zero());
  ASSERT_TRUE(first);
  EXPECT_EQ(first->key.map, 0);
}

}  // namespace
}  // namespace isotherm
