#include "ground/renderer/temperature_scale.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "ground/options/ground_options.pb.h"
#include "ground/renderer/renderer.h"
#include "ground/renderer/ticks.h"

namespace isotherm {
namespace {

constexpr double kExact = 1e-9;

RendererOptions Options(ScaleRule rule) {
  RendererOptions options;
  options.set_scale(rule);
  return options;
}

/// 1..101 °C: mean 51, variance (n^2 - 1) / 12 with n = 101. NaN is mixed in.
std::vector<float> Ramp() {
  std::vector<float> celsius;
  for (int i = 1; i <= 101; ++i) {
    celsius.push_back(static_cast<float>(i));
    celsius.push_back(std::numeric_limits<float>::quiet_NaN());
  }
  return celsius;
}
const double kRampSigma = std::sqrt((101.0 * 101.0 - 1.0) / 12.0);

TEST(TemperatureStatisticsTest, AgreesWithTheClosedFormAndLeavesOutNan) {
  const TemperatureStatistics statistics = Summarize(Ramp());
  EXPECT_EQ(statistics.count, 101U);
  EXPECT_EQ(statistics.min_celsius, 1.0);
  EXPECT_EQ(statistics.max_celsius, 101.0);
  EXPECT_NEAR(statistics.mean_celsius, 51.0, kExact);
  EXPECT_NEAR(statistics.sigma_kelvin, kRampSigma, kExact);
}

TEST(TemperatureScaleTest, MinMaxSpansTheExtremes) {
  const auto scale = ChooseScale(Options(MIN_MAX), Ramp());
  ASSERT_TRUE(scale);
  EXPECT_EQ(scale->min_celsius, 1.0);
  EXPECT_EQ(scale->max_celsius, 101.0);
  EXPECT_FALSE(scale->values_below || scale->values_above);
  EXPECT_NEAR(scale->Fraction(26.0), 0.25, kExact);
}

TEST(TemperatureScaleTest, OneSigmaReachesOneSigma) {
  const auto scale = ChooseScale(Options(ONE_SIGMA), Ramp());
  ASSERT_TRUE(scale);
  EXPECT_NEAR(scale->min_celsius, 51.0 - kRampSigma, kExact);
  EXPECT_NEAR(scale->max_celsius, 51.0 + kRampSigma, kExact);
  EXPECT_TRUE(scale->values_below && scale->values_above);
}

TEST(TemperatureScaleTest, ThreeSigmaCutsOutliersButIsNeverWiderThanTheExtremes) {
  std::vector<float> celsius(999, 20.0F);
  celsius.push_back(1020.0F);  // Mean 21, sigma = sqrt(0.001 * 0.999) * 1000 = 31.6.
  const auto scale = ChooseScale(Options(THREE_SIGMA), celsius);
  ASSERT_TRUE(scale);
  EXPECT_EQ(scale->min_celsius, 20.0);
  EXPECT_NEAR(scale->max_celsius, 21.0 + 3.0 * 1000.0 * std::sqrt(0.001 * 0.999), 1e-6);
  EXPECT_TRUE(scale->values_above);
  EXPECT_FALSE(scale->values_below);
}

TEST(TemperatureScaleTest, FixedNeedsNoTemperatures) {
  const auto scale = ChooseScale(Options(FIXED), {});
  ASSERT_TRUE(scale);
  EXPECT_EQ(scale->min_celsius, 20.0);
  EXPECT_EQ(scale->max_celsius, 100.0);
}

TEST(TemperatureScaleTest, IsNothingYetWithoutTemperatures) {
  EXPECT_FALSE(ChooseScale(Options(THREE_SIGMA), {}));
}

TEST(TemperatureScaleTest, UniformTemperatureIsInTheMiddle) {
  const auto scale = ChooseScale(Options(MIN_MAX), std::vector<float>(5, 40.0F));
  ASSERT_TRUE(scale);
  EXPECT_NEAR(scale->Fraction(40.0), 0.5, kExact);
  EXPECT_NEAR(scale->max_celsius - scale->min_celsius, 0.1, kExact);
}

TEST(PercentileTest, IsExactOnARamp) {
  // 1..101: the p-th percentile is 1 + p. In any order, and with NaN in between.
  std::vector<float> values = Ramp();
  std::mt19937 random(7);
  std::shuffle(values.begin(), values.end(), random);
  for (const double percent : {0.0, 2.0, 2.5, 50.0, 97.75, 100.0}) {
    EXPECT_NEAR(*Percentile(values, percent), 1.0 + percent, kExact) << percent;
  }
  EXPECT_EQ(*Percentile(std::vector<float>{4.0F}, 30.0), 4.0);
  EXPECT_NEAR(*Percentile(std::vector<float>{10.0F, 0.0F}, 25.0), 2.5, kExact);
  EXPECT_FALSE(Percentile(std::vector<float>(3, NAN), 50.0));
}

TEST(TemperatureScaleTest, PercentilesCutBothEnds) {
  RendererOptions options = Options(PERCENTILE);
  options.mutable_expert()->set_percentile_low(10);
  options.mutable_expert()->set_percentile_high(75);
  const auto scale = ChooseScale(options, Ramp());
  ASSERT_TRUE(scale);
  EXPECT_NEAR(scale->min_celsius, 11.0, kExact);
  EXPECT_NEAR(scale->max_celsius, 76.0, kExact);
  EXPECT_TRUE(scale->values_below && scale->values_above);
  EXPECT_EQ(ScaleRuleName(options), "10 to 75 %");
}

TEST(ParseScaleTest, OneTextSetsRuleAndLimits) {
  RendererOptions options;
  ASSERT_TRUE(ParseScale("1-sigma", options).ok());
  EXPECT_EQ(options.scale(), ONE_SIGMA);
  ASSERT_TRUE(ParseScale("-20..68F", options).ok());
  EXPECT_EQ(options.scale(), FIXED);
  EXPECT_EQ(options.scale_min_celsius(), -20.0);
  EXPECT_NEAR(options.scale_max_celsius(), 20.0, kExact);
  ASSERT_TRUE(ParseScale("5..99.5%", options).ok());
  EXPECT_EQ(options.scale(), PERCENTILE);
  EXPECT_EQ(options.expert().percentile_low(), 5.0);
  EXPECT_EQ(options.expert().percentile_high(), 99.5);
  for (const char* wrong : {"", "wide", "20", "20..", "a..b"}) {
    EXPECT_EQ(ParseScale(wrong, options).code(), StatusCode::kInvalidArgument) << wrong;
  }
}

TEST(DisplayUnitTest, ConvertsAsDefined) {
  EXPECT_EQ(DisplayUnitOf(CELSIUS).Of(36.6), 36.6);
  EXPECT_NEAR(DisplayUnitOf(FAHRENHEIT).Of(100.0), 212.0, kExact);
  EXPECT_NEAR(DisplayUnitOf(FAHRENHEIT).Of(-40.0), -40.0, kExact);
  EXPECT_NEAR(DisplayUnitOf(KELVIN).Of(0.0), 273.15, kExact);
  EXPECT_EQ(DisplayUnitOf(KELVIN).name, "K");
}

TEST(ParseCelsiusTest, TakesUnitsAndRefusesWhatIsNoTemperature) {
  EXPECT_EQ(*ParseCelsius(" 60 "), 60.0);
  EXPECT_EQ(*ParseCelsius("-12.5C"), -12.5);
  EXPECT_NEAR(*ParseCelsius("212 F"), 100.0, kExact);
  EXPECT_NEAR(*ParseCelsius("373.15K"), 100.0, kExact);
  for (const char* wrong : {"", "F", "hot", "1 2", "12Q", "inf", "nan", "-274", "-1K", "-460F"}) {
    EXPECT_FALSE(ParseCelsius(wrong)) << wrong;
  }
}

TEST(RendererOptionsTest, EachNewOptionIsChecked) {
  const auto refused = [](auto set, const char* field) {
    RendererOptions options;
    set(options);
    const Status status = Validate(options);
    EXPECT_EQ(status.code(), StatusCode::kInvalidArgument) << field;
    EXPECT_NE(status.message().find(field), std::string::npos) << status.message();
  };
  refused([](auto& o) { o.mutable_expert()->set_percentile_low(98); }, "percentile_low");
  refused([](auto& o) { o.mutable_expert()->set_percentile_low(-1); }, "percentile_low");
  refused([](auto& o) { o.mutable_expert()->set_percentile_high(101); }, "percentile_high");
  refused([](auto& o) { o.mutable_expert()->set_isotherm_width_px(0); }, "isotherm_width_px");
  refused([](auto& o) { o.mutable_expert()->set_isotherm_smoothing_px(-0.1); },
          "isotherm_smoothing_px");
  refused([](auto& o) { o.add_isotherm()->set_colour("warm"); }, "isotherm");
  refused([](auto& o) { o.add_band(); }, "band");
}

TEST(RendererOptionsTest, DefaultsAreValidAndLimitsMustBeInOrder) {
  RendererOptions options;
  EXPECT_TRUE(Validate(options).ok());
  options.set_scale_min_celsius(100.0);
  const Status equal = Validate(options);
  EXPECT_EQ(equal.code(), StatusCode::kInvalidArgument);
  EXPECT_NE(equal.message().find("scale_min_celsius"), std::string::npos);
  options.set_scale_min_celsius(std::numeric_limits<double>::quiet_NaN());
  EXPECT_FALSE(Validate(options).ok());
  options.set_scale_min_celsius(-std::numeric_limits<double>::infinity());
  EXPECT_FALSE(Validate(options).ok());
}

TEST(RoundTicksTest, AreRoundNumbersWithinTheScale) {
  const std::vector<Tick> ticks = RoundTicks(20.3, 101.2, 10);
  ASSERT_EQ(ticks.size(), 8U);
  EXPECT_EQ(ticks.front().label, "30");
  EXPECT_EQ(ticks.back().label, "100");
}

TEST(RoundTicksTest, NarrowScalesGetDecimals) {
  const std::vector<Tick> ticks = RoundTicks(22.95, 23.05, 6);
  ASSERT_EQ(ticks.size(), 5U);
  EXPECT_EQ(ticks.front().label, "22.96");
}

TEST(RoundTicksTest, LimitsCountAlthoughTheyAreNoBinaryFractions) {
  const std::vector<Tick> ticks = RoundTicks(0.3, 0.9, 7);
  ASSERT_EQ(ticks.size(), 7U);
  EXPECT_EQ(ticks.front().label, "0.3");
  EXPECT_EQ(ticks.back().label, "0.9");
}

TEST(RoundTicksTest, NeverMoreThanAskedFor) {
  for (double width = 0.1; width < 3000.0; width *= 1.37) {
    for (int most = 2; most < 12; ++most) {
      const std::size_t count = RoundTicks(-3.7, -3.7 + width, most).size();
      EXPECT_GE(count, 1U) << width;
      EXPECT_LE(count, static_cast<std::size_t>(most)) << width;
    }
  }
}

}  // namespace
}  // namespace isotherm
