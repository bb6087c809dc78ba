#include "common/base/sigma_coverage.h"

#include <gtest/gtest.h>

#include <random>

namespace isotherm {
namespace {

TEST(SigmaCoverageTest, CountsBothSidesAndTheBorders) {
  SigmaCoverage coverage;
  for (const double ratio : {0.0, 1.0, -1.0, 1.01, -1.96, 1.96, 1.97, -5.0}) coverage.Add(ratio);
  EXPECT_EQ(coverage.count(), 8U);
  EXPECT_DOUBLE_EQ(coverage.within_68(), 3.0 / 8.0);
  EXPECT_DOUBLE_EQ(coverage.within_95(), 6.0 / 8.0);
  EXPECT_NEAR(coverage.mean(), -2.02 / 8.0, 1e-12);
}

TEST(SigmaCoverageTest, NormalErrorsHaveTheExpectedFractions) {
  constexpr unsigned kSeed = 5;
  constexpr double kTolerance = 0.005;  // Ten standard deviations of a fraction of 1e6.
  std::mt19937 random(kSeed);
  std::normal_distribution<double> normal;
  SigmaCoverage coverage;
  for (int i = 0; i < 1'000'000; ++i) coverage.Add(normal(random));
  EXPECT_NEAR(coverage.within_68(), SigmaCoverage::kExpected68, kTolerance);
  EXPECT_NEAR(coverage.within_95(), SigmaCoverage::kExpected95, kTolerance);
  EXPECT_NEAR(coverage.mean(), 0.0, kTolerance);
}

TEST(SigmaCoverageTest, NothingIsNotANumber) {
  const SigmaCoverage nothing;
  EXPECT_TRUE(std::isnan(nothing.within_68()));
  EXPECT_TRUE(std::isnan(nothing.within_95()));
  EXPECT_TRUE(std::isnan(nothing.mean()));
}

}  // namespace
}  // namespace isotherm
