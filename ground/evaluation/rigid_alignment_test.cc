#include "ground/evaluation/rigid_alignment.h"

#include <gtest/gtest.h>

#include <random>
#include <vector>

namespace isotherm {
namespace {

constexpr double kExact = 1e-9;
constexpr unsigned kSeed = 17;

using Points = std::vector<Eigen::Vector3d>;

RigidTransform SomeMotion() {
  return MakeTransform({0.3, -1.2, 2.0}, Eigen::Quaterniond(Eigen::AngleAxisd(
                                             1.1, Eigen::Vector3d(1, 2, -1).normalized())));
}

class AlignRigidTest : public ::testing::Test {
 protected:
  Eigen::Vector3d RandomVector(double sigma) {
    std::normal_distribution<double> normal(0.0, sigma);
    return {normal(random_), normal(random_), normal(random_)};
  }
  Points RandomPoints(int count) {
    Points points;
    for (int i = 0; i < count; ++i) points.push_back(RandomVector(0.5));
    return points;
  }
  static Points Moved(const RigidTransform& motion, const Points& points) {
    Points moved;
    for (const Eigen::Vector3d& p : points) moved.push_back(motion * p);
    return moved;
  }
  static double SumOfSquares(const RigidTransform& T, const Points& from, const Points& to) {
    double sum = 0.0;
    for (std::size_t i = 0; i < from.size(); ++i) sum += (to[i] - T * from[i]).squaredNorm();
    return sum;
  }

  std::mt19937 random_{kSeed};
};

TEST_F(AlignRigidTest, RecoversAKnownMotion) {
  const Points from = RandomPoints(50);
  EXPECT_TRUE(AlignRigid(from, Moved(SomeMotion(), from)).isApprox(SomeMotion(), kExact));
}

TEST_F(AlignRigidTest, ThreePointsAreEnough) {
  const Points from{{1, 0, 0}, {0, 2, 0}, {0, 0, 3}};
  EXPECT_TRUE(AlignRigid(from, Moved(SomeMotion(), from)).isApprox(SomeMotion(), kExact));
}

/// The oracle is the definition itself: from the minimum, every small step makes the sum larger.
TEST_F(AlignRigidTest, OfNoisyPointsNoOtherMotionFitsBetter) {
  const Points from = RandomPoints(40);
  Points to = Moved(SomeMotion(), from);
  for (Eigen::Vector3d& p : to) p += RandomVector(0.05);
  const RigidTransform best = AlignRigid(from, to);
  EXPECT_TRUE(IsRigid(best));
  const double min_sum = SumOfSquares(best, from, to);
  EXPECT_LT(min_sum, SumOfSquares(SomeMotion(), from, to)) << "noise moves the minimum";
  for (int i = 0; i < 200; ++i) {
    constexpr double kStep = 1e-3;
    const Eigen::Vector3d axis = RandomVector(1.0).normalized();
    const RigidTransform step =
        MakeTransform(RandomVector(kStep), Eigen::Quaterniond(Eigen::AngleAxisd(kStep, axis)));
    EXPECT_GT(SumOfSquares(step * best, from, to), min_sum);
  }
}

TEST_F(AlignRigidTest, NeverReflects) {
  // Points in a plane, where a reflection would fit as well, and mirrored points, where it would
  // fit better.
  const Points plane{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 2, 0}};
  EXPECT_TRUE(AlignRigid(plane, plane).isApprox(RigidTransform::Identity(), kExact));
  const Points from{{0, 0, 0}, {1, 0, 0}, {0, 2, 0}, {0, 0, 3}};
  Points mirrored = from;
  for (Eigen::Vector3d& p : mirrored) p.x() = -p.x();
  EXPECT_TRUE(IsRigid(AlignRigid(from, mirrored)));
}

TEST_F(AlignRigidTest, FewerThanThreePointsMatchAsFarAsTheyCan) {
  EXPECT_TRUE(AlignRigid({}, {}).isApprox(RigidTransform::Identity()));
  const Points one{{1, 2, 3}}, there{{-4, 0, 1}};
  const RigidTransform shift = AlignRigid(one, there);
  EXPECT_TRUE(IsRigid(shift));
  EXPECT_NEAR((shift * one[0] - there[0]).norm(), 0.0, kExact);
  const Points two{{0, 0, 0}, {1, 0, 0}};
  const RigidTransform rotation = AlignRigid(two, Moved(SomeMotion(), two));
  EXPECT_TRUE(IsRigid(rotation));
  EXPECT_NEAR(SumOfSquares(rotation, two, Moved(SomeMotion(), two)), 0.0, kExact);
}

}  // namespace
}  // namespace isotherm
