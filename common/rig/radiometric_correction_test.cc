#include "common/rig/radiometric_correction.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>

namespace isotherm {
namespace {

using ::testing::HasSubstr;

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

RadiometricCorrection Bent() { return {{20, 100, 200}, {0.5F, 1.5F, 0.5F}, {0.1F, 0.2F, 0.4F}}; }

TEST(RadiometricCorrectionTest, BetweenReadingsItIsLinearBeyondAsAtTheNearest) {
  const RadiometricCorrection correction = Bent();
  ASSERT_TRUE(Validate(correction).ok()) << Validate(correction).message();
  EXPECT_NEAR(correction.At(20.0), 0.5, 1e-6);
  EXPECT_NEAR(correction.At(60.0), 1.0, 1e-6);
  EXPECT_NEAR(correction.At(150.0), 1.0, 1e-6);
  EXPECT_NEAR(correction.At(-40.0), 0.5, 1e-6);
  EXPECT_NEAR(correction.At(900.0), 0.5, 1e-6);
  EXPECT_NEAR(correction.SigmaAt(150.0), 0.3, 1e-6);
  EXPECT_NEAR(correction.SigmaAt(900.0), 0.4, 1e-6);
}

TEST(RadiometricCorrectionTest, AnImageIsCorrectedAsItsPixelsAre) {
  const RadiometricCorrection correction = Bent();
  std::array<float, 9> row = {300.0F, -30.0F, 60.0F, kNan, 20.0F, 199.0F, 100.0F, 200.0F, 21.0F};
  const std::array<float, 9> before = row;
  correction.Correct(row);
  for (std::size_t i = 0; i < row.size(); ++i) {
    if (std::isnan(before[i])) {
      EXPECT_TRUE(std::isnan(row[i]));
    } else {
      EXPECT_NEAR(row[i], before[i] + correction.At(before[i]), 1e-4) << "of " << before[i];
    }
  }
}

TEST(RadiometricCorrectionTest, WithoutReadingsNothingIsCorrected) {
  const RadiometricCorrection none;
  EXPECT_TRUE(Validate(none).ok());
  EXPECT_EQ(none.At(100.0), 0.0);
  std::array<float, 2> row = {30.0F, kNan};
  none.Correct(row);
  EXPECT_EQ(row[0], 30.0F);
}

TEST(RadiometricCorrectionTest, WhatCannotBeIsNamed) {
  const auto message = [](auto change) {
    RadiometricCorrection correction = Bent();
    change(correction);
    return Validate(correction).message();
  };
  using Correction = RadiometricCorrection;
  EXPECT_THAT(message([](Correction& c) { c.sigmas_k.pop_back(); }), HasSubstr("got 3, 3 and 2"));
  EXPECT_THAT(message([](Correction& c) { c.readings_celsius[1] = 20; }), HasSubstr("ascend"));
  EXPECT_THAT(message([](Correction& c) { c.readings_celsius[0] = -kNan; }), HasSubstr("is none"));
  EXPECT_THAT(message([](Correction& c) { c.corrections_k[2] = 101; }), HasSubstr("correction_k"));
  EXPECT_THAT(message([](Correction& c) { c.corrections_k[2] = kNan; }), HasSubstr("correction_k"));
  EXPECT_THAT(message([](Correction& c) { c.sigmas_k[0] = -1; }), HasSubstr("sigma_k"));
  EXPECT_THAT(message([](Correction& c) {
                c.corrections_k = {90, 1, 1};
              }),
              HasSubstr("which it does not after 20 °C"));
  Correction many;
  for (int i = 0; i < 33; ++i) {
    many.readings_celsius.push_back(static_cast<float>(i));
    many.corrections_k.push_back(0.0F);
    many.sigmas_k.push_back(0.0F);
  }
  EXPECT_THAT(Validate(many).message(), HasSubstr("up to 32"));
}

}  // namespace
}  // namespace isotherm
