#include "ground/tracker/initial_pose.h"

#include <gtest/gtest.h>

namespace isotherm {
namespace {

/// Depths are single precision, some 1 m large.
constexpr double kTolerance_m = 1e-6;

class InitialPoseTest : public ::testing::Test {
 protected:
  /// The volume's centre as the first camera sees it.
  Eigen::Vector3d CentreInDepth(const Image<float>& depth_m) const {
    const RigidTransform T_world_depth = PoseFacingCentre(grid_, depth_m);
    EXPECT_TRUE(T_world_depth.linear().isIdentity()) << "axes are parallel";
    return T_world_depth.inverse() * p_centre_;
  }

  /// 0.8 x 1.6 x 0.4 m.
  const VoxelGrid grid_{
      .min_m = {-1.0, 0.5, 2.0}, .voxel_size_m = 0.01, .blocks = GridIndex(10, 20, 5)};
  const Eigen::Vector3d p_centre_{-0.6, 1.3, 2.2};
};

TEST_F(InitialPoseTest, TheCentreIsOnTheOpticalAxisAtTheMedianDepth) {
  Image<float> depth_m(5, 1);
  for (int x = 0; x < 5; ++x)
    depth_m.At(x, 0) = x == 4 ? 100.0F : 0.5F + 0.25F * static_cast<float>(x);
  const Eigen::Vector3d p_depth = CentreInDepth(depth_m);
  EXPECT_LT((p_depth - Eigen::Vector3d(0.0, 0.0, 1.0)).norm(), kTolerance_m)
      << "one far pixel does not move it: " << p_depth.transpose();
}

TEST_F(InitialPoseTest, PixelsWithoutAReturnDoNotCount) {
  Image<float> depth_m(8, 8, 0.0F);
  depth_m.At(3, 4) = 0.7F;
  EXPECT_NEAR(CentreInDepth(depth_m).z(), 0.7, kTolerance_m);
}

TEST_F(InitialPoseTest, WithoutAnyDepthTheCameraIsInTheCentre) {
  EXPECT_LT(CentreInDepth(Image<float>(8, 8, 0.0F)).norm(), kTolerance_m);
}

}  // namespace
}  // namespace isotherm
