#include "ground/camera_calibration/polygon_coverage.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace isotherm {
namespace {

Polygon Circle(const Eigen::Vector2d& centre, double radius, int points, double sense = 1.0) {
  Polygon circle;
  for (int i = 0; i < points; ++i) {
    const double angle = sense * 2.0 * std::numbers::pi * i / points;
    circle.emplace_back(centre + radius * Eigen::Vector2d(std::cos(angle), std::sin(angle)));
  }
  return circle;
}

double Sum(const Image<float>& image) {
  double sum = 0.0;
  for (const float value : image.pixels()) sum += static_cast<double>(value);
  return sum;
}

TEST(PolygonCoverageTest, SquareBetweenCellsCoversPartsOfThem) {
  const Polygon square = {{1.25, 1.5}, {3.5, 1.5}, {3.5, 2.75}, {1.25, 2.75}};
  Image<float> coverage(5, 4);
  Cover(square, coverage);
  EXPECT_FLOAT_EQ(coverage.At(1, 1), 0.75F * 0.5F);
  EXPECT_FLOAT_EQ(coverage.At(2, 1), 0.5F);
  EXPECT_FLOAT_EQ(coverage.At(3, 1), 0.5F * 0.5F);
  EXPECT_FLOAT_EQ(coverage.At(2, 2), 0.75F);
  EXPECT_FLOAT_EQ(coverage.At(0, 0), 0.0F);
  EXPECT_FLOAT_EQ(coverage.At(4, 1), 0.0F);
}

TEST(PolygonCoverageTest, CircleCoversItsAreaAroundItsCentreInEitherSense) {
  for (const double sense : {1.0, -1.0}) {
    const Eigen::Vector2d centre(20.37, 18.81);
    const Polygon circle = Circle(centre, 9.3, 400, sense);
    Image<float> coverage(40, 38);
    Cover(circle, coverage);
    EXPECT_NEAR(Sum(coverage), std::abs(SignedArea(circle)), 1e-3);
    Eigen::Vector2d mean = Eigen::Vector2d::Zero();
    for (int y = 0; y < coverage.height(); ++y) {
      for (int x = 0; x < coverage.width(); ++x) {
        EXPECT_GE(coverage.At(x, y), -1e-5F);
        EXPECT_LE(coverage.At(x, y), 1.00001F);
        mean += static_cast<double>(coverage.At(x, y)) * Eigen::Vector2d(x + 0.5, y + 0.5);
      }
    }
    constexpr double kCells = 5e-3;  // Where within a cell it is covered is lost.
    EXPECT_NEAR((mean / Sum(coverage) - centre).norm(), 0.0, kCells);
    EXPECT_NEAR((Centroid(circle) - centre).norm(), 0.0, 1e-9);
  }
}

TEST(PolygonCoverageTest, WhatLiesBeyondTheImageIsCutOff) {
  Image<float> coverage(10, 10);
  Cover(Circle({0.0, 5.0}, 3.0, 400), coverage);
  EXPECT_NEAR(Sum(coverage), 0.5 * std::numbers::pi * 9.0, 0.01);
  Cover(Circle({10.0, 10.0}, 3.0, 400), coverage);
  EXPECT_NEAR(Sum(coverage), 0.25 * std::numbers::pi * 9.0, 0.01);
}

TEST(PolygonCoverageTest, SharedPartOfTwoCirclesIsTheirLens) {
  const double radius = 5.0, distance = 3.0;
  const Polygon both =
      Intersect(Circle({0.0, 0.0}, radius, 2000), Circle({distance, 0.0}, radius, 2000, -1.0));
  const double half = 0.5 * distance;
  const double lens = 2.0 * radius * radius * std::acos(half / radius) -
                      distance * std::sqrt(radius * radius - half * half);
  EXPECT_NEAR(std::abs(SignedArea(both)), lens, 1e-3);
  EXPECT_TRUE(Intersect(Circle({0.0, 0.0}, 1.0, 50), Circle({3.0, 0.0}, 1.0, 50)).empty());
}

}  // namespace
}  // namespace isotherm
