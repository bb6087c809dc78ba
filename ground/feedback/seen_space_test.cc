#include "ground/feedback/seen_space.h"

#include <gtest/gtest.h>

namespace isotherm {
namespace {

using Eigen::Vector3d;

/// A wall that faces -z across a volume of a metre, and a depth camera before it.
class SeenSpaceTest : public ::testing::Test {
 protected:
  SeenSpaceTest() {
    camera_.width = 320;
    camera_.height = 240;
    camera_.fx = camera_.fy = 285.0;
    camera_.cx = 159.5;
    camera_.cy = 119.5;
  }
  static VoxelGrid Grid() {
    return {.min_m = Vector3d::Zero(), .voxel_size_m = 0.008, .blocks = {16, 16, 16}};
  }
  static RigidTransform From(double x, double y) {
    return MakeTransform({x, y, 0.2}, Eigen::Quaterniond::Identity());
  }
  SeenSpace Space() const { return {Grid(), camera_, 0.8}; }

  CameraModel camera_;
};

TEST_F(SeenSpaceTest, IsSeenWhereTheDepthCameraLookedAndOnlyThere) {
  SeenSpace space = Space();
  const Vector3d ahead(0.5, 0.5, 0.7), beside(0.9, 0.5, 0.7), beyond(0.5, 0.5, 1.015);
  EXPECT_TRUE(space.IsUnseen(ahead));
  space.Look(From(0.5, 0.5));
  EXPECT_FALSE(space.IsUnseen(ahead));
  EXPECT_TRUE(space.IsUnseen(beside)) << "not in view";
  EXPECT_TRUE(space.IsUnseen(beyond)) << "too far to be measured";
}

TEST_F(SeenSpaceTest, OutsideTheVolumeNothingIsToBeSeen) {
  const SeenSpace space = Space();
  EXPECT_FALSE(space.IsUnseen({-0.01, 0.5, 0.5}));
  EXPECT_FALSE(space.IsUnseen({0.5, 0.5, 1.1}));
}

}  // namespace
}  // namespace isotherm
