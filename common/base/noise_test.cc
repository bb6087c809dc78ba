#include "common/base/noise.h"

#include <gtest/gtest.h>

#include <cmath>
#include <iostream>

namespace isotherm {
namespace {

constexpr std::uint64_t kSeed = 6;
constexpr int kCount = 200000;

TEST(NoiseTest, NormalNoiseHasTheMomentsOfANormalDistribution) {
  std::cout << "seed " << kSeed << '\n';
  double sum = 0.0, squares = 0.0, fourth = 0.0, lagged = 0.0, previous = 0.0;
  for (int i = 0; i < kCount; ++i) {
    const auto value = static_cast<double>(NormalNoise(kSeed, static_cast<std::uint64_t>(i)));
    sum += value;
    squares += value * value;
    fourth += value * value * value * value;
    lagged += value * previous;
    previous = value;
  }
  EXPECT_NEAR(sum / kCount, 0.0, 0.01);
  EXPECT_NEAR(squares / kCount, 1.0, 0.01);
  EXPECT_NEAR(fourth / kCount, 3.0 - 1.2 / 8.0, 0.06);  // Sum of eight uniforms.
  EXPECT_NEAR(lagged / kCount, 0.0, 0.01);
}

TEST(NoiseTest, UniformNoiseFillsTheUnitInterval) {
  double sum = 0.0;
  for (int i = 0; i < kCount; ++i) {
    const double value = UniformNoise(kSeed, static_cast<std::uint64_t>(i));
    ASSERT_GE(value, 0.0);
    ASSERT_LT(value, 1.0);
    sum += value;
  }
  EXPECT_NEAR(sum / kCount, 0.5, 0.003);
}

TEST(NoiseTest, StreamsDiffer) {
  EXPECT_NE(NoiseStream(1, 0, 0), NoiseStream(2, 0, 0));
  EXPECT_NE(NoiseStream(1, 0, 0), NoiseStream(1, 1, 0));
  EXPECT_NE(NoiseStream(1, 0, 0), NoiseStream(1, 0, 1));
}

}  // namespace
}  // namespace isotherm
