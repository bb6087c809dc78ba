#include "edge/nuc/warm_up_watch.h"

#include <gtest/gtest.h>

#include <cmath>

#include "edge/options/edge_options.pb.h"

namespace isotherm {
namespace {

using State = WarmUpWatch::State;

class WarmUpWatchTest : public testing::Test {
 protected:
  State Update(double seconds, double fpa_celsius) {
    ThermalHousekeeping housekeeping;
    housekeeping.fpa_celsius = static_cast<float>(fpa_celsius);
    return watch_.Update(start_ + FromSeconds(seconds), housekeeping);
  }

  NucOptions options_;
  CaptureTime start_{std::chrono::hours(1)};
  WarmUpWatch watch_{options_};
};

TEST_F(WarmUpWatchTest, IsWarmWhenTheDetectorChangesSlowlyEnough) {
  // As a detector warms up (fig. 3.4a): exponentially, here with 40 s and 8 K. It changes by less
  // than 1 K in a minute, measured over 30 s behind, from the time t on at which
  // 2 * 8 K * (exp(-(t - 30) / 40) - exp(-t / 40)) = 1 K.
  const double expected_s = 40.0 * std::log(16.0 * (std::exp(30.0 / 40.0) - 1.0));
  double warm_s = 0.0;
  while (warm_s < 600.0 && Update(warm_s, 40.0 - 8.0 * std::exp(-warm_s / 40.0)) != State::kWarm)
    warm_s += 0.025;
  EXPECT_NEAR(warm_s, expected_s, 2.0) << "one sample a second";
}

TEST_F(WarmUpWatchTest, IsNotAssessedBeforeItsTime) {
  EXPECT_EQ(Update(0, 35.0), State::kNotAssessed);
  EXPECT_EQ(Update(29, 35.0), State::kNotAssessed);
  EXPECT_EQ(Update(30, 35.0), State::kWarm);
}

TEST_F(WarmUpWatchTest, CoolingIsNoEquilibriumEither) {
  for (int s = 0; s < 100; ++s) EXPECT_NE(Update(s, 50.0 - 0.05 * s), State::kWarm);
  EXPECT_NEAR(watch_.change().value().k_per_min, -3.0, 0.01);
}

/// The housing goes on for 20 minutes when the detector has settled.
TEST_F(WarmUpWatchTest, IsNotWarmBeforeItsHousingIs) {
  // 5 K with 7 minutes; 0.1 K/min, measured over the two minutes behind, from the time on at which
  // 5 K * (exp(-(t - 2) / 7) - exp(-t / 7)) = 0.2 K.
  const double expected_min = 7.0 * std::log(25.0 * (std::exp(2.0 / 7.0) - 1.0));
  ThermalHousekeeping housekeeping;
  housekeeping.fpa_celsius = 35.0F;
  int warm_s = 0;
  for (; warm_s < 3600; ++warm_s) {
    housekeeping.housing_celsius = static_cast<float>(33.0 - 5.0 * std::exp(-warm_s / 60.0 / 7.0));
    if (watch_.Update(start_ + FromSeconds(warm_s), housekeeping) == State::kWarm) break;
    if (warm_s == 180) {
      ASSERT_TRUE(watch_.change().has_value());
      EXPECT_STREQ(watch_.change()->part, "housing");
    }
  }
  EXPECT_NEAR(warm_s / 60.0, expected_min, 0.1);
  EXPECT_GT(warm_s, 10 * 60);
}

TEST_F(WarmUpWatchTest, ACameraThatTellsItsHousingOnlyIsAssessedByThat) {
  ThermalHousekeeping housekeeping;
  housekeeping.housing_celsius = 30.0F;
  EXPECT_EQ(watch_.Update(start_, housekeeping), State::kNotAssessed);
  EXPECT_EQ(watch_.Update(start_ + FromSeconds(119), housekeeping), State::kNotAssessed);
  EXPECT_EQ(watch_.Update(start_ + FromSeconds(120), housekeeping), State::kWarm);
}

TEST_F(WarmUpWatchTest, AColdCameraIsColdUntilAllIsWarm) {
  ThermalHousekeeping housekeeping;
  housekeeping.housing_celsius = 30.0F;
  State state = State::kNotAssessed;
  for (int s = 0; s <= 130; ++s) {
    // The detector is cold for a minute, and settles before the housing could be assessed.
    housekeeping.fpa_celsius = static_cast<float>(30.0 + 0.1 * std::min(s, 60));
    state = watch_.Update(start_ + FromSeconds(s), housekeeping);
    if (s >= 30 && s < 120) {
      EXPECT_EQ(state, State::kCold) << s;
    }
  }
  EXPECT_EQ(state, State::kWarm);
}

TEST_F(WarmUpWatchTest, ATemperatureThatIsMissingOnceDoesNotMakeItWarm) {
  ThermalHousekeeping housekeeping;
  housekeeping.fpa_celsius = 35.0F;
  for (int s = 0; s < 300; ++s) {
    housekeeping.housing_celsius = 30.0F + 0.01F * static_cast<float>(s);
    if (s == 250) housekeeping.housing_celsius = static_cast<float>(kUnknown_celsius);
    ASSERT_NE(watch_.Update(start_ + FromSeconds(s), housekeeping), State::kWarm) << s;
  }
}

TEST_F(WarmUpWatchTest, WithoutTemperaturesTimeCounts) {
  EXPECT_EQ(Update(0, kUnknown_celsius), State::kCold);
  EXPECT_EQ(Update(179, kUnknown_celsius), State::kCold);
  EXPECT_NEAR(ToSeconds(watch_.left()), 1.0, 1e-6);
  EXPECT_EQ(Update(180, kUnknown_celsius), State::kWarm);
}

TEST_F(WarmUpWatchTest, OnceWarmItStaysSo) {
  for (int s = 0; s <= 30; ++s) Update(s, 35.0);
  for (int s = 31; s < 100; ++s) EXPECT_EQ(Update(s, 35.0 + s), State::kWarm);
}

}  // namespace
}  // namespace isotherm
