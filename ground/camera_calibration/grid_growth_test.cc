#include "ground/camera_calibration/grid_growth.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>

namespace isotherm {
namespace {

/// A grid as a camera shows it: tilted, turned and bent a little.
std::vector<Eigen::Vector2d> Seen(const CalibrationTarget& target, double turn_rad, bool mirrored) {
  std::vector<Eigen::Vector2d> points;
  for (int i = 0; i < target.features(); ++i) {
    Eigen::Vector2d p = (target.FeaturePosition(i) - target.Middle()) / target.square_m;
    if (mirrored) p.x() = -p.x();
    p = Eigen::Rotation2Dd(turn_rad) * p;
    p.x() *= 0.7;                         // Tilt
    p /= 1.0 + 0.03 * p.x();              // with perspective;
    p *= 1.0 - 0.0008 * p.squaredNorm();  // the lens bends.
    points.emplace_back(200.0 + 20.0 * p.x(), 150.0 + 20.0 * p.y());
  }
  return points;
}

class GridGrowthTest : public ::testing::TestWithParam<const char*> {};

TEST_P(GridGrowthTest, FeaturesAreNumberedAsOnTheFrontHoweverItIsTurned) {
  const CalibrationTarget target = *ParseTarget(GetParam());
  for (const double turn : {0.0, 0.7, 1.9, -2.4}) {
    const std::vector<Eigen::Vector2d> seen = Seen(target, turn, false);
    std::vector<Eigen::Vector2d> shuffled = seen;
    std::rotate(shuffled.begin(), shuffled.begin() + 5, shuffled.end());
    shuffled.emplace_back(350.0, 20.0);  // Something else.
    const auto grid = GrowGrid(shuffled, target);
    ASSERT_TRUE(grid.has_value());
    ASSERT_EQ(grid->features.size(), seen.size()) << turn;
    std::vector<Eigen::Vector2d> turned = seen;
    std::reverse(turned.begin(), turned.end());
    const bool as_it_is = grid->features == seen;
    EXPECT_TRUE(as_it_is || (target.IsAmbiguous() && grid->features == turned)) << turn;
  }
}

INSTANTIATE_TEST_SUITE_P(Patterns, GridGrowthTest,
                         ::testing::Values("asymmetric-circles 4x9 0.05",
                                           "asymmetric-circles 4x6 0.05",
                                           "symmetric-circles 6x4 0.02", "square-holes 5x7 0.02"));

TEST(GridGrowthSizeTest, TheSizeThatIsThereIsTold) {
  const CalibrationTarget there = *ParseTarget("asymmetric-circles 4x11 0.05");
  const auto grid = GrowGrid(Seen(there, 0.4, false), *ParseTarget("asymmetric-circles 4x9 0.05"));
  ASSERT_TRUE(grid.has_value());
  EXPECT_TRUE(grid->features.empty());
  EXPECT_EQ(grid->columns, 4);
  EXPECT_EQ(grid->rows, 11);
}

TEST(GridGrowthSizeTest, AMirrorImageIsToldFromTheFrontIfThePatternDoes) {
  const CalibrationTarget even = *ParseTarget("asymmetric-circles 4x6 0.05");
  EXPECT_TRUE(GrowGrid(Seen(even, 0.3, true), even)->mirrored);
  EXPECT_FALSE(GrowGrid(Seen(even, 0.3, false), even)->mirrored);
  // With an odd number of rows the mirror image is the target turned over: nothing tells.
  const CalibrationTarget odd = *ParseTarget("asymmetric-circles 4x9 0.05");
  EXPECT_FALSE(GrowGrid(Seen(odd, 0.3, true), odd)->mirrored);
}

TEST(GridGrowthSizeTest, ThingsBesideTheTargetInLineWithItDoNotCount) {
  const CalibrationTarget target = *ParseTarget("square-holes 6x4 0.02");
  std::vector<Eigen::Vector2d> seen = Seen(target, 0.1, false);
  const std::vector<Eigen::Vector2d> alone = seen;
  // In line with the second row and the third column.
  seen.emplace_back(seen[11] + (seen[11] - seen[10]));
  seen.emplace_back(seen[2] - (seen[8] - seen[2]));
  const auto grid = GrowGrid(seen, target);
  ASSERT_TRUE(grid.has_value());
  EXPECT_EQ(grid->features, alone);
}

TEST(GridGrowthSizeTest, ScatteredPointsAreNoGrid) {
  std::vector<Eigen::Vector2d> points;
  for (int i = 0; i < 12; ++i) points.emplace_back(17.0 * i * i, 31.0 * (i * 7 % 12) + i);
  EXPECT_FALSE(GrowGrid(points, *ParseTarget("symmetric-circles 6x4 0.02")).has_value());
}

}  // namespace
}  // namespace isotherm
