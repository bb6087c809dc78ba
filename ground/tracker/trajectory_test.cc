#include "ground/tracker/trajectory.h"

#include <gtest/gtest.h>

#include <numbers>

#include "ground/surface/testing/analytic_views.h"

namespace isotherm {
namespace {

constexpr double kRounding_m = 1e-9;

CaptureTime At(double s) { return CaptureTime(FromSeconds(s)); }

StampedMapPose PoseAt(double time_s, const Eigen::Vector3d& p_map) {
  return {At(time_s), MakeTransform(p_map, Eigen::Quaterniond::Identity())};
}

/// Two sub-maps; the second is not joined.
class TrajectoryTest : public ::testing::Test {
 protected:
  TrajectoryTest() { EXPECT_TRUE(atlas_.BeginElsewhere()); }

  static VoxelGrid SmallGrid() {
    VolumeOptions volume;
    volume.set_size_x_m(0.16);
    volume.set_size_y_m(0.16);
    volume.set_size_z_m(0.16);
    return MakeVoxelGrid(volume).value();
  }
  /// Says where the second sub-map is: turned by 90 degrees about z (its x is y in `world`), and
  /// moved.
  void Join(const Eigen::Vector3d& p_world) {
    const Eigen::AngleAxisd rotation(std::numbers::pi / 2.0, Eigen::Vector3d::UnitZ());
    atlas_.map(1).joined = true;
    atlas_.map(1).T_world_map = MakeTransform(p_world, Eigen::Quaterniond(rotation));
  }
  void ExpectPose(std::size_t i, double time_s, const Eigen::Vector3d& p_world, double sigma_m) {
    ASSERT_LT(i, trajectory_.poses().size());
    ASSERT_EQ(trajectory_.sigmas().size(), trajectory_.poses().size());
    const StampedPose& pose = trajectory_.poses()[i];
    EXPECT_EQ(pose.time, At(time_s));
    EXPECT_LT((pose.T_world_depth.translation() - p_world).norm(), kRounding_m)
        << pose.T_world_depth.translation().transpose();
    EXPECT_EQ(trajectory_.sigmas()[i].translation_m, sigma_m);
  }

  Atlas atlas_{GroundOptions(), testing::SmallDepthCamera(), SmallGrid()};
  Trajectory trajectory_;
};

TEST_F(TrajectoryTest, PosesAreInWorldWhereverTheirSubMapIs) {
  Join({1.0, 2.0, 3.0});
  trajectory_.Add(PoseAt(10.0, {0.5, 0.0, 0.0}), {.translation_m = 0.001}, 0, atlas_);
  trajectory_.Add(PoseAt(10.1, {0.5, 0.0, 0.0}), {.translation_m = 0.002}, 1, atlas_);
  ASSERT_EQ(trajectory_.poses().size(), 2U);
  ExpectPose(0, 10.0, {0.5, 0.0, 0.0}, 0.001);
  ExpectPose(1, 10.1, {1.0, 2.5, 3.0}, 0.002);
  const Eigen::Vector3d x_axis = trajectory_.poses()[1].T_world_depth.linear().col(0);
  EXPECT_LT((x_axis - Eigen::Vector3d::UnitY()).norm(), kRounding_m);
}

TEST_F(TrajectoryTest, PosesOfASubMapThatIsNotJoinedComeWithIt) {
  trajectory_.Add(PoseAt(10.0, {0.1, 0.0, 0.0}), {.translation_m = 0.001}, 0, atlas_);
  trajectory_.Add(PoseAt(10.1, {0.2, 0.0, 0.0}), {.translation_m = 0.002}, 1, atlas_);
  trajectory_.Add(PoseAt(10.2, {0.3, 0.0, 0.0}), {.translation_m = 0.003}, 0, atlas_);
  ASSERT_EQ(trajectory_.poses().size(), 2U);
  ExpectPose(1, 10.2, {0.3, 0.0, 0.0}, 0.003);
  Join({0.0, 0.0, 1.0});
  trajectory_.Update(atlas_);
  ASSERT_EQ(trajectory_.poses().size(), 3U);
  ExpectPose(0, 10.0, {0.1, 0.0, 0.0}, 0.001);
  ExpectPose(1, 10.1, {0.0, 0.2, 1.0}, 0.002);
  ExpectPose(2, 10.2, {0.3, 0.0, 0.0}, 0.003);
}

TEST_F(TrajectoryTest, ClosingALoopMovesWhatCameBefore) {
  Join({0.0, 0.0, 1.0});
  trajectory_.Add(PoseAt(10.0, {0.2, 0.0, 0.0}), {.translation_m = 0.001}, 1, atlas_);
  Join({0.0, 0.0, 1.5});
  ExpectPose(0, 10.0, {0.0, 0.2, 1.0}, 0.001);
  trajectory_.Update(atlas_);
  ASSERT_EQ(trajectory_.poses().size(), 1U);
  ExpectPose(0, 10.0, {0.0, 0.2, 1.5}, 0.001);
}

TEST_F(TrajectoryTest, ALinkOfTheAtlasCountsOnceItIsTold) {
  const RigidTransform pose = testing::FirstPose();
  const RigidTransform T_world_map = MakeTransform({1.0, 2.0, 3.0}, Eigen::Quaterniond::Identity());
  trajectory_.Add({At(10.0), pose}, {.translation_m = 0.001}, 0, atlas_);
  trajectory_.Add({At(10.1), pose}, {.translation_m = 0.002}, 1, atlas_);
  atlas_.Link(0, pose, T_world_map * pose);
  EXPECT_EQ(trajectory_.poses().size(), 1U) << "until it is told";
  trajectory_.Update(atlas_);
  ASSERT_EQ(trajectory_.poses().size(), 2U);
  ExpectPose(1, 10.1, pose.translation() + Eigen::Vector3d(1.0, 2.0, 3.0), 0.002);
}

}  // namespace
}  // namespace isotherm
