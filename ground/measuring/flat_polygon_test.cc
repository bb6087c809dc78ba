#include "ground/measuring/flat_polygon.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace isotherm {
namespace {

using Corners = std::vector<Eigen::Vector2d>;
using Corner3 = std::array<Eigen::Vector2d, 3>;

const Corners kSquare = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
/// An L: the unit square of 2 x 2 without its upper right quarter.
const Corners kAngle = {{0, 0}, {2, 0}, {2, 1}, {1, 1}, {1, 2}, {0, 2}};
constexpr double kRounding = 1e-12;

TEST(FlatPolygonTest, AreaIsPositiveCounterClockwise) {
  EXPECT_DOUBLE_EQ(SignedArea(kSquare), 1.0);
  EXPECT_DOUBLE_EQ(SignedArea(Corners(kSquare.rbegin(), kSquare.rend())), -1.0);
  EXPECT_DOUBLE_EQ(SignedArea(kAngle), 3.0);
}

TEST(FlatPolygonTest, ATriangleInsideCountsWhole) {
  EXPECT_NEAR(FractionInside(Corner3{Eigen::Vector2d(0.2, 0.2), {0.6, 0.3}, {0.4, 0.8}}, kSquare),
              1.0, kRounding);
}

TEST(FlatPolygonTest, ATriangleOutsideDoesNotCount) {
  EXPECT_NEAR(FractionInside(Corner3{Eigen::Vector2d(2.2, 0.2), {2.6, 0.3}, {2.4, 0.8}}, kSquare),
              0.0, kRounding);
}

TEST(FlatPolygonTest, ATriangleAcrossASideCountsByItsPart) {
  // Its right half, a triangle of a quarter of the area, sticks out.
  EXPECT_NEAR(FractionInside(Corner3{Eigen::Vector2d(0.5, 0.2), {1.5, 0.2}, {0.5, 0.8}}, kSquare),
              0.75, kRounding);
}

TEST(FlatPolygonTest, TheSenseOfNeitherMatters) {
  const Corner3 turned = {Eigen::Vector2d(0.5, 0.8), {1.5, 0.2}, {0.5, 0.2}};
  EXPECT_NEAR(FractionInside(turned, kSquare), 0.75, kRounding);
  EXPECT_NEAR(FractionInside(turned, Corners(kSquare.rbegin(), kSquare.rend())), 0.75, kRounding);
}

TEST(FlatPolygonTest, APolygonInsideATriangleCountsByItsArea) {
  EXPECT_NEAR(FractionInside(Corner3{Eigen::Vector2d(-4, -4), {8, -4}, {-4, 8}}, kSquare),
              1.0 / 72.0, kRounding);
}

TEST(FlatPolygonTest, TrianglesOfATilingSumUpToAConcavePolygon) {
  // Any tiling of the plane cuts a polygon into parts that are the polygon again.
  std::mt19937 random(5);
  std::uniform_real_distribution<double> shift(0.0, 0.3);
  const Eigen::Vector2d offset(shift(random), shift(random));
  constexpr double kSide = 0.3;
  double sum = 0.0;
  for (int y = -3; y < 10; ++y) {
    for (int x = -3; x < 10; ++x) {
      const Eigen::Vector2d a = kSide * Eigen::Vector2d(x, y) + offset;
      const Eigen::Vector2d b = a + Eigen::Vector2d(kSide, 0), c = a + Eigen::Vector2d(0, kSide);
      const Eigen::Vector2d d = a + Eigen::Vector2d(kSide, kSide);
      sum += 0.5 * kSide * kSide *
             (FractionInside(Corner3{a, b, c}, kAngle) + FractionInside(Corner3{b, d, c}, kAngle));
    }
  }
  EXPECT_NEAR(sum, 3.0, 1e-9);
}

TEST(FlatPolygonTest, ATriangleWithoutAreaHasNoFraction) {
  EXPECT_EQ(FractionInside(Corner3{Eigen::Vector2d(0.1, 0.1), {0.2, 0.2}, {0.3, 0.3}}, kSquare),
            0.0);
}

}  // namespace
}  // namespace isotherm
