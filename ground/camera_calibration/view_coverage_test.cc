#include "ground/camera_calibration/view_coverage.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/base/units.h"

namespace isotherm {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

const Eigen::Vector2i kSize(300, 200);

std::vector<Eigen::Vector2d> Around(double x, double y) {
  std::vector<Eigen::Vector2d> features;
  for (int row = 0; row < 6; ++row) {
    for (int column = 0; column < 6; ++column)
      features.emplace_back(x + 3.0 * column, y + 3.0 * row);
  }
  return features;
}

RigidTransform Tilted(double degrees, const Eigen::Vector3d& axis, double distance_m) {
  return MakeTransform({0.0, 0.0, distance_m},
                       Eigen::Quaterniond(Eigen::AngleAxisd(degrees * kRadPerDeg, axis)));
}

/// Everything that a careful person does.
ViewCoverage Complete() {
  ViewCoverage coverage(kSize);
  int view = 0;
  for (int repeat = 0; repeat < 4; ++repeat) {
    for (const double x : {1.0, 140.0, 281.0}) {
      for (const double y : {1.0, 90.0, 183.0}) {
        const Eigen::Vector3d axis =
            view % 2 == 0 ? Eigen::Vector3d::UnitX() : Eigen::Vector3d::UnitY();
        coverage.Add(Around(x, y),
                     Tilted(view % 4 < 2 ? 35.0 : -35.0, axis, 0.6 + 0.1 * (view % 5)));
        ++view;
      }
    }
  }
  return coverage;
}

TEST(ViewCoverageTest, NothingIsMissingWhenEverythingWasShown) {
  EXPECT_THAT(Complete().Missing(), IsEmpty());
}

TEST(ViewCoverageTest, CornersThatNoViewReachedAreNamed) {
  ViewCoverage coverage(kSize);
  for (int i = 0; i < 40; ++i)
    coverage.Add(Around(140.0, 90.0), Tilted(0.0, Eigen::Vector3d::UnitX(), 0.7));
  EXPECT_THAT(coverage.Missing(),
              Contains(HasSubstr("no views with the target in the upper left corner")));
  EXPECT_THAT(coverage.Missing(),
              Contains(HasSubstr("no views with the target in the lower right corner")));
  EXPECT_THAT(coverage.Missing(), Not(Contains(HasSubstr("in the middle"))));
  EXPECT_THAT(coverage.Missing(), Contains(HasSubstr("no views with the target tilted")));
  EXPECT_THAT(coverage.Missing(), Contains(HasSubstr("same distance")));
}

TEST(ViewCoverageTest, TheSideThatIsNearerIsTheOneInTheImage) {
  ViewCoverage coverage(kSize);
  // Turned about y by a positive angle, points on the right (x > 0) move towards the camera.
  for (int i = 0; i < 3; ++i)
    coverage.Add(Around(140.0, 90.0), Tilted(35.0, Eigen::Vector3d::UnitY(), 0.7));
  EXPECT_THAT(coverage.Missing(), Not(Contains(HasSubstr("right side nearer"))));
  EXPECT_THAT(coverage.Missing(), Contains(HasSubstr("left side nearer")));
}

TEST(ViewCoverageTest, FewViewsAreSaid) {
  ViewCoverage coverage(kSize);
  coverage.Add(Around(140.0, 90.0), Tilted(0.0, Eigen::Vector3d::UnitX(), 0.7));
  EXPECT_THAT(coverage.Missing(), Contains(HasSubstr("1 views of 30")));
}

}  // namespace
}  // namespace isotherm
