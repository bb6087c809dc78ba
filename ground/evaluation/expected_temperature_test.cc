#include "ground/evaluation/expected_temperature.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include <cmath>
#include <random>

#include "common/base/units.h"

namespace isotherm {
namespace {

constexpr SmoothSurface kPaint{
    .normal_emissivity = 0.96, .refractive_index = 1.5, .reflected_celsius = 23.0};
constexpr double kCelsius = 120.0;

TEST(ExpectedTemperatureTest, AlongTheNormalAndWithoutAnAngleItIsThatOfTheNormalEmissivity) {
  const BandRadiance band;
  const double along_normal = ApparentCelsius(band, kCelsius, 0.96, 23.0);
  EXPECT_DOUBLE_EQ(ExpectTemperature(band, kPaint, kCelsius, NAN, 5.0).celsius, along_normal);
  EXPECT_EQ(ExpectTemperature(band, kPaint, kCelsius, NAN, 5.0).sigma_k, 0.0);
  EXPECT_NEAR(ExpectTemperature(band, kPaint, kCelsius, 0.0, 0.0).celsius, along_normal, 1e-9);
}

TEST(ExpectedTemperatureTest, ItsUncertaintyIsTheSpreadOverUncertainAngles) {
  const BandRadiance band;
  std::mt19937_64 random(5);
  for (const double angle_deg : {30.0, 45.0, 60.0}) {
    constexpr double kSigma_deg = 1.2;
    const ExpectedTemperature expected =
        ExpectTemperature(band, kPaint, kCelsius, angle_deg, kSigma_deg);
    std::normal_distribution<double> angles(angle_deg, kSigma_deg);
    constexpr int kDraws = 20'000;
    double sum = 0.0, squares = 0.0;
    for (int i = 0; i < kDraws; ++i) {
      const double emissivity = DirectionalEmissivity(angles(random) * kRadPerDeg, 0.96, 1.5, 0.0);
      const double off_k = ApparentCelsius(band, kCelsius, emissivity, 23.0) - expected.celsius;
      sum += off_k;
      squares += off_k * off_k;
    }
    const double mean_k = sum / kDraws;
    const double spread_k = std::sqrt(squares / kDraws - mean_k * mean_k);
    EXPECT_NEAR(expected.sigma_k, spread_k, 0.05 * spread_k) << angle_deg;
    EXPECT_GT(expected.sigma_k, 0.0);
  }
}

TEST(ExpectedTemperatureTest, ANormalThatIsOffMakesTheAngleUncertain) {
  const Eigen::Vector3f up = Eigen::Vector3f::UnitZ();
  const Eigen::Vector3f tilted =
      Eigen::AngleAxisf(static_cast<float>(6.0 * kRadPerDeg), Eigen::Vector3f::UnitX()) * up;
  EXPECT_NEAR(AngleSigmaDeg(up, up), 1.0, 0.05);
  EXPECT_NEAR(AngleSigmaDeg(tilted, up), std::hypot(1.0, 6.0 / std::sqrt(2.0)), 0.01);
  EXPECT_NEAR(AngleSigmaDeg(tilted, -up), AngleSigmaDeg(tilted, up), 1e-6);
}

}  // namespace
}  // namespace isotherm
