#include "ground/radiometric_calibration/correction_curve.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace isotherm {
namespace {

using ::testing::HasSubstr;

/// Set points of a camera that reads `reading(apparent)`.
template <typename Reading>
std::vector<SetPoint> SetPoints(std::initializer_list<double> apparent, const Reading& reading,
                                double common_sigma_k = 0.0) {
  std::vector<SetPoint> points;
  for (const double celsius : apparent)
    points.push_back({celsius, reading(celsius), 0.0, common_sigma_k});
  return points;
}

TEST(CorrectionCurveTest, ALineIsFound) {
  const auto reading = [](double celsius) { return 1.5 + 0.98 * celsius; };
  const Result<CurveReport> found = FitCurve(SetPoints({20, 50, 80, 120}, reading, 0.3));
  ASSERT_TRUE(found) << found.error().message();
  EXPECT_EQ(found->degree, 1);
  for (const double celsius : {20.0, 35.0, 90.0, 120.0})
    EXPECT_NEAR(found->correction.At(reading(celsius)), celsius - reading(celsius), 1e-4);
  EXPECT_NEAR(found->correction.SigmaAt(60.0), 0.3, 1e-3) << "what all are off by is not lost";
  EXPECT_NEAR(found->held_out_k, 0.0, 1e-6);
  EXPECT_NEAR(found->before_k, std::sqrt((1.1 * 1.1 + 0.5 * 0.5 + 0.1 * 0.1 + 0.9 * 0.9) / 4.0),
              1e-6);
}

TEST(CorrectionCurveTest, AParabolaIsFoundToo) {
  const auto reading = [](double celsius) { return celsius - 1e-4 * std::pow(celsius - 60.0, 2); };
  const Result<CurveReport> found = FitCurve(SetPoints({0, 30, 60, 90, 120, 150}, reading));
  ASSERT_TRUE(found) << found.error().message();
  EXPECT_EQ(found->degree, 2);
  for (const double celsius : {10.0, 75.0, 140.0})
    EXPECT_NEAR(found->correction.At(reading(celsius)), celsius - reading(celsius), 0.02);
}

/// Noise must not make a curve of it.
TEST(CorrectionCurveTest, WhereALineTellsNoMoreItIsAnOffset) {
  int offsets = 0;
  constexpr int kSeeds = 50;
  for (int seed = 0; seed < kSeeds; ++seed) {
    std::mt19937 engine(static_cast<unsigned>(seed));
    std::normal_distribution<double> noise(0.0, 0.2);
    const Result<CurveReport> found = FitCurve(SetPoints(
        {20, 40, 60, 80, 100, 120}, [&](double celsius) { return celsius - 1.0 + noise(engine); }));
    ASSERT_TRUE(found);
    if (found->degree > 0) continue;
    ++offsets;
    EXPECT_NEAR(found->correction.At(70.0), 1.0, 0.4);
  }
  EXPECT_GT(offsets, kSeeds * 7 / 10);
}

/// The uncertainty is what the correction is off by.
TEST(CorrectionCurveTest, SigmaHoldsWhatSetPointsStrayBy) {
  constexpr double kSigma_k = 0.2;
  double squares = 0.0;
  int count = 0;
  for (int seed = 0; seed < 200; ++seed) {
    std::mt19937 engine(static_cast<unsigned>(seed));
    std::normal_distribution<double> noise(0.0, kSigma_k);
    const auto camera = [](double celsius) { return 2.0 + 0.95 * celsius; };
    const Result<CurveReport> found =
        FitCurve(SetPoints({20, 40, 60, 80, 100, 120, 140, 160},
                           [&](double celsius) { return camera(celsius) + noise(engine); }));
    ASSERT_TRUE(found);
    for (const double celsius : {25.0, 95.0, 155.0}) {
      // Another set point strays as these did.
      const double reading = camera(celsius) + noise(engine);
      const double wrong_k = celsius - reading - found->correction.At(reading);
      squares += std::pow(wrong_k / found->correction.SigmaAt(reading), 2);
      ++count;
    }
  }
  EXPECT_GT(std::sqrt(squares / count), 0.8);
  EXPECT_LT(std::sqrt(squares / count), 1.4);
}

TEST(CorrectionCurveTest, OneSetPointTellsAnOffset) {
  const Result<CurveReport> found = FitCurve({{100.0, 98.5, 0.4, 0.3}});
  ASSERT_TRUE(found) << found.error().message();
  EXPECT_NEAR(found->correction.At(20.0), 1.5, 1e-6);
  EXPECT_NEAR(found->correction.SigmaAt(20.0), 0.5, 1e-6);
  EXPECT_TRUE(std::isnan(found->held_out_k));
}

TEST(CorrectionCurveTest, ASetPointThatIsUncertainTellsLess) {
  // The middle one is 3 K off, and says that it may be.
  const auto points = [](double sigma_k) {
    return std::vector<SetPoint>{{20, 19, 0.1}, {60, 62, sigma_k}, {100, 99, 0.1}, {140, 139, 0.1}};
  };
  EXPECT_NEAR(FitCurve(points(5.0)).value().correction.At(60.0), 1.0, 0.05);
  EXPECT_LT(FitCurve(points(0.1)).value().correction.At(60.0), 0.5);
}

TEST(CorrectionCurveTest, WhatAllAreOffByTogetherMayGrow) {
  const std::vector<SetPoint> points = {
      {20, 19, 0.0, 0.2}, {60, 59, 0.0, 0.3}, {100, 99, 0.0, 0.5}};
  const RadiometricCorrection correction = FitCurve(points).value().correction;
  EXPECT_EQ(correction.sigmas_k.size(), 1U) << "an offset, known as in the middle";
  EXPECT_NEAR(correction.sigmas_k.front(), 0.3, 1e-3);
}

TEST(CorrectionCurveTest, WhatPredictsNothingBetterIsNotKnown) {
  const std::vector<SetPoint> right = {{20, 20.3}, {60, 59.7}, {100, 100.3}};
  EXPECT_FALSE(FitCurve(right).value().IsKnown());
  const std::vector<SetPoint> wrong = {{20, 22.3}, {60, 61.7}, {100, 102.3}};
  EXPECT_TRUE(FitCurve(wrong).value().IsKnown());
}

TEST(CorrectionCurveTest, WhatMakesNoCurveIsRefused) {
  EXPECT_THAT(FitCurve({}).error().message(), HasSubstr("no set point"));
  // A camera that reads the same before everything.
  const auto stuck =
      SetPoints({20, 40, 60, 80}, [](double celsius) { return 50.0 + 0.01 * celsius; });
  const Result<CurveReport> found = FitCurve(stuck);
  ASSERT_TRUE(found) << "readings are one: all that can be told is an offset";
  EXPECT_GT(found->correction.SigmaAt(50.0), 20.0);
  EXPECT_THAT(FitCurve({{300.0, 20.0}}).error().message(), HasSubstr("no correction of a camera"));
}

}  // namespace
}  // namespace isotherm
