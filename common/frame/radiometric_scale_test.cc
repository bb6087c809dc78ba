#include "common/frame/radiometric_scale.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>

namespace isotherm {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kFloat_k = 1e-4;  // Rounding of a float at 1500 °C.

TEST(RadiometricScaleTest, IsCentikelvinUnlessSaidOtherwise) {
  EXPECT_FLOAT_EQ(RadiometricScale().Celsius(29'315), 20.0F);
  EXPECT_EQ(RadiometricScale().CountOf(20.0), 29'315);
  EXPECT_NEAR(RadiometricScale().max_celsius(), 382.2, 1e-9);
}

TEST(RadiometricScaleTest, EachTemperatureOfTheRangeComesBackWithinHalfAStep) {
  for (const auto& [low, high, step_k] :
       {std::tuple(-20.0, 100.0, 0.01), std::tuple(0.0, 250.0, 0.01),
        std::tuple(150.0, 900.0, 0.02), std::tuple(-40.0, 1500.0, 0.03),
        std::tuple(-40.0, 2000.0, 0.05)}) {
    const auto scale = ScaleForRange(low, high);
    ASSERT_TRUE(scale) << scale.error().message();
    EXPECT_EQ(scale->kelvin_per_count, step_k);
    for (double celsius = low; celsius <= high; celsius += 0.0137) {
      const std::uint16_t count = scale->CountOf(celsius);
      ASSERT_NE(count, 0) << celsius;
      ASSERT_NEAR(scale->Celsius(count), celsius, step_k / 2.0 + kFloat_k) << celsius;
    }
  }
}

TEST(RadiometricScaleTest, WhatDoesNotFitHasNoValueOrIsCut) {
  const RadiometricScale scale{0.02, 100.0};  // -173.13 to 1137.55 °C.
  EXPECT_EQ(scale.CountOf(1138.0), 0);
  EXPECT_EQ(scale.NearestCountOf(1138.0), 65'535);
  EXPECT_EQ(scale.CountOf(-173.2), 0);
  EXPECT_EQ(scale.NearestCountOf(-300.0), 1);
  EXPECT_EQ(scale.CountOf(kNan), 0);
  EXPECT_EQ(scale.NearestCountOf(kNan), 0);
  EXPECT_EQ(scale.CountOf(1137.55), 65'535);
}

TEST(RadiometricScaleTest, ImpossibleOnesAreRefusedByTheNameOfTheirField) {
  const auto refusal = [](double scale, double offset) {
    return Validate(RadiometricScale{scale, offset}).message();
  };
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  EXPECT_EQ(refusal(0.01, 0.0), "");
  EXPECT_EQ(refusal(0.1, 173.15), "");
  for (const double scale : {0.0, -0.01, kNan, kInfinity, 2.0})
    EXPECT_NE(refusal(scale, 0.0).find("thermal_scale"), std::string::npos) << scale;
  for (const double offset : {kNan, kInfinity, -kInfinity, 20'000.0})
    EXPECT_NE(refusal(0.01, offset).find("thermal_offset"), std::string::npos) << offset;
  EXPECT_NE(refusal(0.0001, 0.0).find("16 bits reach"), std::string::npos) << "ends at 6.6 K";
  EXPECT_NE(refusal(0.01, 2'000.0).find("16 bits reach"), std::string::npos) << "begins at 1727 °C";
}

TEST(RadiometricScaleTest, ARangeThatFitsNoScaleIsRefused) {
  EXPECT_FALSE(ScaleForRange(-20.0, 3'100.0));
  EXPECT_FALSE(ScaleForRange(-300.0, 100.0));
  EXPECT_FALSE(ScaleForRange(100.0, 100.0));
  EXPECT_FALSE(ScaleForRange(kNan, 100.0));
}

}  // namespace
}  // namespace isotherm
