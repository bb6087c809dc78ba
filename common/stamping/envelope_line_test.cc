#include "common/stamping/envelope_line.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace isotherm {
namespace {

constexpr std::size_t kGroup = 15;
constexpr double kWindow_s = 30.0;
constexpr double kMaxSlope = 200e-6;
constexpr double kPeriod_s = 1.0 / 30.0;
constexpr double kSlope = 50e-6;
constexpr double kJitter_s = 0.001;

EnvelopeLine MakeLine() { return {kGroup, kWindow_s, kMaxSlope}; }

TEST(EnvelopeLineTest, IsReadyWithTheFirstFullGroup) {
  EnvelopeLine line = MakeLine();
  for (std::size_t i = 0; i < kGroup; ++i) {
    EXPECT_FALSE(line.ready()) << i;
    line.Add({.x = kPeriod_s * static_cast<double>(i), .y = i == 4 ? 0.001 : 0.003});
  }
  ASSERT_TRUE(line.ready());
  EXPECT_EQ(line.At(0.2), 0.001);
  EXPECT_NEAR(line.Sigma(0.2), 0.002 * 14.0 / 15.0, 1e-9) << "the others are 2 ms above";
  line.Clear();
  EXPECT_FALSE(line.ready());
}

TEST(EnvelopeLineTest, FramesThatAreLateMoveNothing) {
  EnvelopeLine line = MakeLine();
  const auto truth = [](double x) { return 0.004 + kSlope * x; };
  for (int i = 0; i < 1500; ++i) {
    const double x = kPeriod_s * i;
    const bool busy = x > 18.0 && x < 30.0;  // Then all of them, else two of three.
    line.Add({.x = x, .y = truth(x) + (busy || i % 3 > 0 ? 0.006 + 1e-5 * (i % 13) : 0.0)});
    if (x < 10.0) continue;
    ASSERT_NEAR(line.At(x), truth(x), 1e-9) << x;
    ASSERT_NEAR(line.slope(), kSlope, 1e-9) << x;
  }
}

TEST(EnvelopeLineTest, TheSlopeIsLimited) {
  EnvelopeLine line = MakeLine();
  for (int i = 0; i < 300; ++i) line.Add({.x = kPeriod_s * i, .y = -0.01 * i});
  EXPECT_EQ(line.slope(), -kMaxSlope);
}

TEST(EnvelopeLineTest, OldDriftIsForgottenAfterTwoWindows) {
  EnvelopeLine line = MakeLine();
  const auto truth = [](double x) { return x < 100.0 ? kSlope * x : kSlope * (200.0 - x); };
  double x = 0.0;
  for (; x < 100.0 + 2.0 * kWindow_s + 1.0; x += kPeriod_s) line.Add({.x = x, .y = truth(x)});
  EXPECT_NEAR(line.slope(), -kSlope, 1e-9);
  EXPECT_NEAR(line.At(x), truth(x), 1e-9);
}

/// The lowest of 15 standard normal values is at -1.736 on average (tables of order statistics).
constexpr double kMeanOfLowest = -1.736;

TEST(EnvelopeLineTest, SigmaIsTheStandardErrorWhenJitterIsNormal) {
  constexpr int kRuns = 200;
  double squares = 0.0, sigma_squares = 0.0;
  for (int run = 0; run < kRuns; ++run) {
    std::mt19937 random(static_cast<unsigned>(run));
    std::normal_distribution<double> jitter(0.0, kJitter_s);
    EnvelopeLine line = MakeLine();
    double x = 0.0;
    for (int i = 0; i < 1350; ++i, x += kPeriod_s)
      line.Add({.x = x, .y = kSlope * x + jitter(random)});
    const double error_s = line.At(x) - (kSlope * x + kMeanOfLowest * kJitter_s);
    squares += error_s * error_s;
    sigma_squares += line.Sigma(x) * line.Sigma(x);
  }
  const double rms_s = std::sqrt(squares / kRuns);
  // 200 runs give the standard error of the ratio as 5 %; outliers that are cut cost a little.
  EXPECT_NEAR(rms_s / std::sqrt(sigma_squares / kRuns), 1.0, 0.25);
  EXPECT_LT(rms_s, 0.2 * kJitter_s) << "the hull alone is uncertain by half the jitter";
}

}  // namespace
}  // namespace isotherm
