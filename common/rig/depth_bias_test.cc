#include "common/rig/depth_bias.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

namespace isotherm {
namespace {

using ::testing::HasSubstr;

/// Grows to the right, downwards and with the distance.
DepthBias Rising() {
  return {.columns = 3,
          .rows = 2,
          .distances_m = {0.5F, 1.0F},
          .multipliers = {1.00F, 1.01F, 1.02F, 1.03F, 1.04F, 1.05F,  //
                          1.10F, 1.11F, 1.12F, 1.13F, 1.14F, 1.15F}};
}

TEST(DepthBiasTest, BetweenNodesItIsLinear) {
  const DepthBias bias = Rising();
  ASSERT_TRUE(Validate(bias).ok()) << Validate(bias).message();
  EXPECT_NEAR(bias.At(0.0, 0.0, 0.5), 1.00, 1e-6);
  EXPECT_NEAR(bias.At(1.0, 1.0, 0.5), 1.05, 1e-6);
  EXPECT_NEAR(bias.At(0.25, 0.0, 0.5), 1.005, 1e-6);
  EXPECT_NEAR(bias.At(0.25, 0.5, 0.5), 1.02, 1e-6);
  EXPECT_NEAR(bias.At(0.25, 0.5, 0.6), 1.04, 1e-6);
}

TEST(DepthBiasTest, BeyondItIsAsAtTheNearest) {
  const DepthBias bias = Rising();
  EXPECT_NEAR(bias.At(-0.2, 0.0, 0.3), 1.00, 1e-6);
  EXPECT_NEAR(bias.At(1.3, 2.0, 9.0), 1.15, 1e-6);
}

TEST(DepthBiasTest, WithoutNodesNothingIsWrong) {
  EXPECT_TRUE(Validate(DepthBias()).ok());
  EXPECT_EQ(DepthBias().At(0.5, 0.5, 1.0), 1.0);
}

TEST(DepthBiasTest, WhatCannotBeIsNamed) {
  const auto message = [](const auto& change) {
    DepthBias bias = Rising();
    change(bias);
    return Validate(bias).message();
  };
  EXPECT_THAT(message([](DepthBias& b) { b.columns = 1; }), HasSubstr("columns and rows"));
  EXPECT_THAT(message([](DepthBias& b) { b.rows = 1000; }), HasSubstr("columns and rows"));
  EXPECT_THAT(message([](DepthBias& b) { b.columns = 4; }), HasSubstr("need 16 values, got 12"));
  EXPECT_THAT(message([](DepthBias& b) { b.distances_m = {1.0F, 0.5F}; }), HasSubstr("ascending"));
  EXPECT_THAT(message([](DepthBias& b) { b.distances_m = {0.0F, 0.5F}; }), HasSubstr("above 0"));
  EXPECT_THAT(message([](DepthBias& b) { b.distances_m.clear(); }), HasSubstr("distance_m"));
  EXPECT_THAT(message([](DepthBias& b) { b.multipliers[3] = 2.0F; }), HasSubstr("0.8..1.25"));
  EXPECT_THAT(
      message([](DepthBias& b) { b.multipliers[3] = std::numeric_limits<float>::quiet_NaN(); }),
      HasSubstr("0.8..1.25"));
}

}  // namespace
}  // namespace isotherm
