#include "ground/console/rig_path.h"

#include <gtest/gtest.h>

namespace isotherm {
namespace {

TEST(RigPathTest, PointsNearTheLastOneAreLeftOut) {
  RigPath path;
  EXPECT_TRUE(path.Add(0, {0, 0, 0}));
  EXPECT_FALSE(path.Add(0, {0.001, 0, 0}));
  EXPECT_TRUE(path.Add(0, {0.01, 0, 0}));
  EXPECT_EQ(path.points(), 2U);
}

TEST(RigPathTest, LostTrackingAndOtherSubMapsBeginAPiece) {
  RigPath path;
  path.Add(0, {0, 0, 0});
  path.Break();
  path.Add(0, {0.1, 0, 0});
  path.Add(1, {0.2, 0, 0});
  const live::Path message = path.ToMessage();
  ASSERT_EQ(message.parts_size(), 3);
  EXPECT_EQ(message.parts(2).map(), 1U);
  EXPECT_EQ(message.parts(1).positions_size(), 3);
  EXPECT_FLOAT_EQ(message.parts(1).positions(0), 0.1F);
}

TEST(RigPathTest, ALongWayIsThinnedOutNotCutOff) {
  RigPath path;
  for (int i = 0; i < 100'000; ++i) path.Add(0, {0.01 * i, 0, 0});
  EXPECT_LE(path.points(), 4001U);
  const live::Path message = path.ToMessage();
  EXPECT_FLOAT_EQ(message.parts(0).positions(0), 0.0F);
  EXPECT_GT(message.parts(0).positions(message.parts(0).positions_size() - 3), 999.0F);
}

TEST(RigPathTest, MemoryStaysBoundedWhenTrackingFlickers) {
  RigPath path;
  for (int i = 0; i < 20'000; ++i) {
    path.Break();
    path.Add(0, {0.01 * i, 0, 0});
  }
  EXPECT_LE(path.points(), 4001U);
}

}  // namespace
}  // namespace isotherm
