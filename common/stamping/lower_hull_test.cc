#include "common/stamping/lower_hull.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <vector>

namespace isotherm {
namespace {

/// The highest line below all points at x: the best of those through two points, by trying all.
double ReferenceHeight(const std::vector<LowerHull::Point>& points, double x) {
  double best = -1e300;
  for (const LowerHull::Point& a : points) {
    for (const LowerHull::Point& b : points) {
      if (b.x <= a.x) continue;
      const double slope = (b.y - a.y) / (b.x - a.x);
      const bool below = std::all_of(points.begin(), points.end(), [&](const auto& point) {
        return point.y >= a.y + slope * (point.x - a.x) - 1e-12;
      });
      if (below) best = std::max(best, a.y + slope * (x - a.x));
    }
  }
  return best;
}

TEST(LowerHullTest, EqualsTheBestOfAllLines) {
  std::mt19937 random(5);
  std::exponential_distribution<double> late(1.0);
  std::vector<LowerHull::Point> points;
  LowerHull hull;
  for (double x = 0.0; x < 60.0; x += 1.0) {
    points.push_back({.x = x, .y = 0.1 * x + late(random)});
    hull.Add(points.back());
    if (x == 0.0) continue;
    const double middle = 0.5 * x;
    EXPECT_NEAR(hull.Below(middle).At(middle), ReferenceHeight(points, middle), 1e-9) << x;
  }
  EXPECT_LT(hull.corners(), 20U);
}

TEST(LowerHullTest, ASteepEdgeIsReplacedByTheTangentOfTheLimit) {
  LowerHull hull;
  hull.Add({.x = 0.0, .y = 0.0});
  hull.Add({.x = 1.0, .y = 5.0});
  hull.Add({.x = 2.0, .y = 20.0});
  const LowerHull::Line line = hull.Below(1.5, 2.0);
  EXPECT_EQ(line.slope, 2.0);
  EXPECT_EQ(line.At(0.0), 0.0);
}

TEST(LowerHullTest, OfPointsAtOnePlaceTheLowestCounts) {
  LowerHull hull;
  hull.Add({.x = 1.0, .y = 3.0});
  hull.Add({.x = 1.0, .y = 2.0});
  hull.Add({.x = 1.0, .y = 4.0});
  EXPECT_EQ(hull.Below(1.0).At(1.0), 2.0);
}

}  // namespace
}  // namespace isotherm
