#include "common/geometry/map_pose.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <random>

#include "common/base/units.h"

namespace isotherm {
namespace {

using Vector6 = Eigen::Matrix<double, 6, 1>;

constexpr double kRounding = 1e-12;
constexpr unsigned kSeed = 31;

RigidTransform Rotation(double angle_deg, const Eigen::Vector3d& axis,
                        const Eigen::Vector3d& translation) {
  return MakeTransform(translation, Eigen::Quaterniond(Eigen::AngleAxisd(angle_deg * kRadPerDeg,
                                                                         axis.normalized())));
}

/// The pose that differs from `pose` by a small twist, as docs/frames.md says: its origin is moved,
/// and it is rotated about its origin, both along the axes of the left coordinate frame.
RigidTransform Disturbed(const RigidTransform& pose, const Vector6& twist) {
  RigidTransform result = pose;
  const double angle = twist.tail<3>().norm();
  if (angle > 0.0) {
    result.linear() =
        Eigen::AngleAxisd(angle, twist.tail<3>() / angle).toRotationMatrix() * pose.linear();
  }
  result.translation() = pose.translation() + twist.head<3>();
  return result;
}

/// The twist that Disturbed takes from `from` to `to`.
Vector6 Difference(const RigidTransform& from, const RigidTransform& to) {
  const Eigen::AngleAxisd rotation(Eigen::Matrix3d(to.linear() * from.linear().transpose()));
  Vector6 twist;
  twist << to.translation() - from.translation(), rotation.angle() * rotation.axis();
  return twist;
}

/// Everything of it is correlated with everything.
PoseCovariance Correlated(std::mt19937& random) {
  std::normal_distribution<double> normal;
  const PoseCovariance factor = PoseCovariance::NullaryExpr([&] { return 1e-4 * normal(random); });
  return factor * factor.transpose();
}

TEST(MapPoseTest, ALargeAxisComesOutAlongTheRotatedAxis) {
  MapPose pose;
  pose.T_map_depth = Rotation(30.0, {1.0, 0.5, 0.0}, {0.3, -0.2, 0.7});
  pose.covariance.diagonal() << 4e-4, 1e-6, 2e-6, 3e-8, 9e-4, 5e-8;
  // The sub-map's x axis is world's y axis, and its y axis is world's -x axis.
  const RigidTransform T_world_map = Rotation(90.0, Eigen::Vector3d::UnitZ(), {5.0, -3.0, 2.0});
  const WorldPose world = ToWorld(pose, T_world_map);
  EXPECT_TRUE(world.T_world_depth.isApprox(T_world_map * pose.T_map_depth, kRounding));
  Vector6 expected;
  expected << 1e-6, 4e-4, 2e-6, 9e-4, 3e-8, 5e-8;
  EXPECT_LT((world.covariance - PoseCovariance(expected.asDiagonal())).norm(), kRounding)
      << world.covariance;
}

TEST(MapPoseTest, OfASubMapThatIsWorldNothingChanges) {
  std::mt19937 random(kSeed);
  const MapPose pose{0, Rotation(50.0, {0.1, 1.0, 0.3}, {1.0, 2.0, 3.0}), Correlated(random)};
  const WorldPose world = ToWorld(pose, RigidTransform::Identity());
  EXPECT_EQ(world.T_world_depth.matrix(), pose.T_map_depth.matrix());
  EXPECT_EQ(world.covariance, pose.covariance);
}

/// The Jacobian of the twist in `world` by that in the sub-map, column by column.
TEST(MapPoseTest, CovarianceFollowsTheFiniteDifferencesOfThePose) {
  constexpr double kStep = 1e-6;
  constexpr double kRelative = 1e-6;  // Of central differences in double precision.
  std::mt19937 random(kSeed);
  for (int i = 0; i < 20; ++i) {
    const RigidTransform T_world_map = Rotation(17.0 * i, {0.3, -1.0, 0.2 * i}, {2.0, 0.1 * i, -4});
    const MapPose pose{0, Rotation(-25.0 * i, {1.0, 0.4, 0.1}, {0.5, -0.3 * i, 1.0}),
                       Correlated(random)};
    const WorldPose world = ToWorld(pose, T_world_map);
    PoseCovariance J;
    for (int k = 0; k < 6; ++k) {
      const Vector6 step = kStep * Vector6::Unit(k);
      J.col(k) =
          (Difference(world.T_world_depth, T_world_map * Disturbed(pose.T_map_depth, step)) -
           Difference(world.T_world_depth, T_world_map * Disturbed(pose.T_map_depth, -step))) /
          (2.0 * kStep);
    }
    const PoseCovariance expected = J * pose.covariance * J.transpose();
    EXPECT_LT((world.covariance - expected).norm(), kRelative * expected.norm()) << i;
    EXPECT_TRUE(IsCovariance(world.covariance));
  }
}

TEST(MapPoseTest, CovarianceIsThatOfManyDisturbedPoses) {
  constexpr int kSamples = 20'000;
  constexpr double kSamplingError = 0.05;  // Five standard deviations of a sampled variance.
  std::mt19937 random(kSeed);
  std::normal_distribution<double> normal;
  const RigidTransform T_world_map = Rotation(110.0, {1.0, -0.4, 0.8}, {3.0, -2.0, 1.0});
  const MapPose pose{0, Rotation(40.0, {0.2, 1.0, -0.5}, {0.6, 0.9, -1.3}), Correlated(random)};
  const WorldPose world = ToWorld(pose, T_world_map);
  const PoseCovariance factor = pose.covariance.llt().matrixL();
  PoseCovariance sampled = PoseCovariance::Zero();
  for (int i = 0; i < kSamples; ++i) {
    const Vector6 twist = factor * Vector6::NullaryExpr([&] { return normal(random); });
    const Vector6 seen =
        Difference(world.T_world_depth, T_world_map * Disturbed(pose.T_map_depth, twist));
    sampled += seen * seen.transpose() / kSamples;
  }
  for (int i = 0; i < 6; ++i) {
    for (int j = 0; j < 6; ++j) {
      const double scale = std::sqrt(world.covariance(i, i) * world.covariance(j, j));
      EXPECT_NEAR(sampled(i, j), world.covariance(i, j), kSamplingError * scale)
          << i << ' ' << j << ", seed " << kSeed;
    }
  }
}

}  // namespace
}  // namespace isotherm
