#include "ground/radiometric_calibration/housing_drift_fit.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace isotherm {
namespace {

using ::testing::HasSubstr;

/// A camera that warms up by `warm_up_k` with a time constant of 200 s, with a NUC each minute.
std::vector<DriftSample> WarmUp(double warm_up_k, double error_per_kelvin, unsigned seed,
                                double reading_noise_k = 0.05) {
  std::mt19937 engine(seed);
  std::normal_distribution<double> noise(0.0, reading_noise_k);
  const auto housing = [&](double time_s) { return warm_up_k * (1.0 - std::exp(-time_s / 200.0)); };
  std::vector<DriftSample> samples;
  for (int i = 0; i < 2400; ++i) {
    const double time_s = 0.1 * i;
    const int epoch = static_cast<int>(time_s / 60.0);
    const double change_k = housing(time_s) - housing(60.0 * epoch);
    // Each NUC leaves an error of its own.
    const double reading = 30.0 + 0.3 * std::cos(3.0 * epoch) + error_per_kelvin * change_k;
    samples.push_back({time_s, epoch, change_k, reading + noise(engine)});
  }
  return samples;
}

TEST(HousingDriftFitTest, TheSlopeIsFoundWithItsUncertainty) {
  double squares = 0.0;
  constexpr unsigned kSeeds = 40;
  for (unsigned seed = 0; seed < kSeeds; ++seed) {
    const Result<DriftReport> found = FitHousingDrift(WarmUp(5.0, 4.0, seed));
    ASSERT_TRUE(found) << found.error().message();
    EXPECT_NEAR(found->drift.error_per_kelvin, 4.0, 0.02);
    EXPECT_EQ(found->epochs, 4);
    EXPECT_EQ(found->frames, 2400U);
    EXPECT_TRUE(found->IsKnown());
    EXPECT_LT(found->held_out_k, 0.02);
    squares += std::pow((found->drift.error_per_kelvin - 4.0) / found->drift.sigma, 2) / kSeeds;
  }
  EXPECT_GT(std::sqrt(squares), 0.7);
  EXPECT_LT(std::sqrt(squares), 1.4);
}

/// A slope that is another in each epoch is no more certain than they agree.
TEST(HousingDriftFitTest, EpochsThatDifferMakeItUncertain) {
  std::vector<DriftSample> samples = WarmUp(5.0, 4.0, 1, 0.01);
  for (DriftSample& sample : samples)
    sample.reading_celsius += (sample.epoch % 2 == 0 ? 0.5 : -0.5) * sample.housing_change_k;
  const Result<DriftReport> found = FitHousingDrift(samples);
  ASSERT_TRUE(found) << found.error().message();
  EXPECT_GT(found->drift.sigma, 0.15);
  EXPECT_TRUE(found->IsKnown());
}

TEST(HousingDriftFitTest, ACameraThatDoesNotDriftIsNotCorrected) {
  const Result<DriftReport> found = FitHousingDrift(WarmUp(5.0, 0.0, 1));
  ASSERT_TRUE(found) << found.error().message();
  EXPECT_NEAR(found->drift.error_per_kelvin, 0.0, 0.02);
  EXPECT_FALSE(found->IsKnown());
}

TEST(HousingDriftFitTest, AWarmCameraTellsNothing) {
  EXPECT_THAT(FitHousingDrift(WarmUp(0.2, 4.0, 1)).error().message(),
              HasSubstr("from switching it on"));
  EXPECT_THAT(FitHousingDrift({}).error().message(), HasSubstr("from switching it on"));
  std::vector<DriftSample> without_nuc = WarmUp(5.0, 4.0, 1);
  for (DriftSample& sample : without_nuc) sample.epoch = 0;
  EXPECT_THAT(FitHousingDrift(without_nuc).error().message(), HasSubstr("1 parts between NUCs"));
  std::vector<DriftSample> few = WarmUp(5.0, 4.0, 1);
  few.resize(150);
  EXPECT_THAT(FitHousingDrift(few).error().message(), HasSubstr("too few"));
}

}  // namespace
}  // namespace isotherm
