#include "ground/evaluation/uncertainty_evaluation.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <random>
#include <vector>

namespace isotherm {
namespace {

constexpr std::uint64_t kSeed = 3;

/// Normal errors with the stated uncertainty times `factor`.
std::vector<AssessedError> NormalErrors(double factor) {
  std::mt19937_64 random(kSeed);
  std::normal_distribution<double> normal;
  std::vector<AssessedError> errors;
  for (int i = 0; i < 20'000; ++i) {
    const double sigma_k = 0.05 + 0.01 * (i % 100);
    errors.push_back({.error_k = factor * sigma_k * normal(random), .sigma_k = sigma_k});
  }
  return errors;
}

TEST(EvaluateUncertaintyTest, RightUncertaintiesCoverAsManyErrorsAsTheyShould) {
  constexpr double kTolerance = 0.01;  // Three standard deviations of 20 000 draws.
  const UncertaintyReport right = EvaluateUncertainty(NormalErrors(1.0));
  EXPECT_NEAR(right.coverage.within_68(), SigmaCoverage::kExpected68, kTolerance);
  EXPECT_NEAR(right.coverage.within_95(), SigmaCoverage::kExpected95, kTolerance);
  EXPECT_NEAR(right.coverage.mean(), 0.0, 0.03);
  EXPECT_NEAR(right.median_sigma_k, 0.55, 0.01);
  const UncertaintyReport too_small = EvaluateUncertainty(NormalErrors(2.0));
  EXPECT_NEAR(too_small.coverage.within_68(), 0.383, kTolerance) << "half a standard deviation";
  EXPECT_NEAR(EvaluateUncertainty(NormalErrors(0.5)).coverage.within_68(), 0.954, kTolerance);
}

TEST(EvaluateUncertaintyTest, CountsEveryRatioOnceAndLeavesOutWhatIsNotKnown) {
  std::vector<AssessedError> errors;
  for (const double ratio : {-7.0, -5.0, -0.1, 0.0, 0.4, 4.99, 5.0, 30.0})
    errors.push_back({.error_k = 0.5 * ratio, .sigma_k = 0.5});
  errors.push_back({.error_k = 1.0});
  const UncertaintyReport report = EvaluateUncertainty(errors);
  EXPECT_EQ(report.coverage.count(), 8U);
  EXPECT_EQ(report.unknown, 1U);
  EXPECT_EQ(report.ratios.below, 1U);
  EXPECT_EQ(report.ratios.above, 2U);
  EXPECT_EQ(report.ratios.counts.front(), 1U) << "the border itself";
  EXPECT_EQ(report.ratios.counts[9], 1U);
  EXPECT_EQ(report.ratios.counts[10], 2U);
  EXPECT_EQ(report.ratios.counts.back(), 1U);
}

TEST(EvaluateUncertaintyTest, TheTableHasErrorsWhereTheyWereMeasured) {
  std::vector<AssessedError> errors;
  for (int i = 1; i <= 3; ++i) {
    errors.push_back({.error_k = -0.1 * i, .sigma_k = 0.2, .distance_m = 0.5, .angle_deg = 39.9});
  }
  errors.push_back({.error_k = 9.0, .distance_m = 0.95, .angle_deg = 60.0});
  errors.push_back({.error_k = 9.0, .distance_m = 0.95});  // No angle: in no cell.
  const ErrorTable table = EvaluateUncertainty(errors).table;
  EXPECT_EQ(table.cells[3][2].count, 3U);
  EXPECT_DOUBLE_EQ(table.cells[3][2].median_k, 0.2);
  EXPECT_DOUBLE_EQ(table.cells[3][2].median_sigma_k, 0.2);
  EXPECT_EQ(table.cells[7][5].count, 1U);
  EXPECT_TRUE(std::isnan(table.cells[7][5].median_sigma_k));
  std::size_t all = 0;
  for (const auto& row : table.cells)
    for (const ErrorCell& cell : row) all += cell.count;
  EXPECT_EQ(all, 4U);
}

TEST(EvaluateUncertaintyTest, OfNothingNothingIsSaid) {
  const UncertaintyReport report = EvaluateUncertainty({});
  EXPECT_EQ(report.coverage.count(), 0U);
  EXPECT_TRUE(std::isnan(report.coverage.within_68()));
  EXPECT_TRUE(std::isnan(report.table.cells[0][0].median_k));
}

}  // namespace
}  // namespace isotherm
