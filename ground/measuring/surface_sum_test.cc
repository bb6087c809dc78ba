#include "ground/measuring/surface_sum.h"

#include <gtest/gtest.h>

#include <cmath>

namespace isotherm {
namespace {

CloudPoint Point(float celsius, std::uint8_t distance_class = 1, float sigma_k = NAN) {
  CloudPoint point;
  point.celsius = celsius;
  point.distance_class = distance_class;
  point.angle_class = 1;
  point.sigma_k = sigma_k;
  return point;
}

class SurfaceSumTest : public ::testing::Test {
 protected:
  Interpretation AsItIs() const { return *Interpretation::Create(InterpretationOptions()); }
  const ObjectParameterValues values_{.emissivity = 0.9,
                                      .reflected_celsius = 20.0,
                                      .material = "",
                                      .air_celsius = 25.0,
                                      .film_coefficient_w_m2k = 10.0};
};

TEST_F(SurfaceSumTest, StatisticsAreWeightedByArea) {
  const Interpretation interpretation = AsItIs();
  SurfaceSum sum(interpretation, values_);
  sum.Add(Point(20.0F, 1, 0.3F), 3.0);
  sum.Add(Point(40.0F, 1, 0.4F), 1.0);
  const auto statistics = sum.object();
  ASSERT_TRUE(statistics);
  EXPECT_DOUBLE_EQ(statistics->min_celsius(), 20.0);
  EXPECT_DOUBLE_EQ(statistics->max_celsius(), 40.0);
  EXPECT_NEAR(statistics->mean_celsius(), 25.0, 1e-9);
  EXPECT_NEAR(statistics->deviation_k(), std::sqrt(75.0), 1e-6);  // (3 * 5^2 + 15^2) / 4.
  EXPECT_NEAR(statistics->sigma_k(), std::sqrt((3 * 0.09 + 0.16) / 4.0), 1e-6);
}

TEST_F(SurfaceSumTest, HeatFlowIsThatOfAGreyBodyAndOfTheAir) {
  // 350 K against 300 K: 0.9 * 5.670374419e-8 * (350^4 - 300^4) = 352.449 W/m2.
  const ObjectParameterValues values{.emissivity = 0.9,
                                     .reflected_celsius = 26.85,
                                     .material = "",
                                     .air_celsius = 16.85,
                                     .film_coefficient_w_m2k = 5.0};
  EXPECT_NEAR(RadiatedHeat_w_m2(76.85, values), 352.449, 0.001);
  EXPECT_NEAR(ConvectedHeat_w_m2(76.85, values), 300.0, 1e-9);
}

TEST_F(SurfaceSumTest, WhatWasNotMeasuredIsInTheAreaButNotInTheHeat) {
  const Interpretation interpretation = AsItIs();
  SurfaceSum sum(interpretation, values_);
  sum.Add(Point(80.0F), 2.0);
  sum.Add(Point(NAN, kNeverMeasured), 1.0);
  sum.Add(Point(NAN, 0), 1.0);  // Tried from a bad distance.
  EXPECT_DOUBLE_EQ(sum.total(), 4.0);
  EXPECT_DOUBLE_EQ(sum.quality().good(), 0.5);
  EXPECT_DOUBLE_EQ(sum.quality().bad(), 0.25);
  EXPECT_DOUBLE_EQ(sum.quality().never(), 0.25);
  const measuring::HeatFlow flow = sum.heat_flow();
  EXPECT_DOUBLE_EQ(flow.measured_m2(), 2.0);
  EXPECT_NEAR(flow.convection_w(), 2.0 * 10.0 * 55.0, 1e-9);
  EXPECT_NEAR(flow.extrapolated_w(), 2.0 * flow.total_w(), 1e-9);
}

TEST_F(SurfaceSumTest, NothingMeasuredHasNoStatistics) {
  const Interpretation interpretation = AsItIs();
  SurfaceSum sum(interpretation, values_);
  EXPECT_FALSE(sum.object());
  sum.Add(Point(NAN, kNeverMeasured), 1.0);
  EXPECT_FALSE(sum.object());
  EXPECT_EQ(sum.heat_flow().total_w(), 0.0);
}

}  // namespace
}  // namespace isotherm
