#include "ground/calibration/delay_search.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "common/base/noise.h"

namespace isotherm {
namespace {

using testing::HasSubstr;

constexpr double kTruth_s = -0.0317;
constexpr int kParts = 8;
// Of the parabola on a cost that is not quite one.
constexpr double kTolerance_s = 0.0003;

/// Parts whose minima scatter by `scatter_s` about the truth; each as steep as `steepness` says.
DisagreementOf Bowl(double scatter_s, double steepness = 1.0) {
  return [scatter_s, steepness](double delay_s, bool /*fine*/,
                                const std::vector<PartWeights>& resamplings) {
    std::vector<double> result;
    for (const PartWeights& weights : resamplings) {
      double sum = 0.0, count = 0.0;
      for (std::uint64_t part = 0; part < weights.size(); ++part) {
        const double off_s = delay_s - kTruth_s - scatter_s * NormalNoise(7, part);
        const double cost = 1.0 - std::exp(-0.5 * (off_s / 0.03) * (off_s / 0.03));
        sum += weights[part] * (1.0 + steepness * cost);
        count += weights[part];
      }
      result.push_back(sum / count);
    }
    return result;
  };
}

const WeighAt kAnyWeights = [](double) {};

TEST(DelaySearchTest, TheMinimumIsFoundBetweenTheGridPoints) {
  const Result<DelayEstimate> found = SearchDelay(Bowl(0.0), kAnyWeights, kParts, {}, {});
  ASSERT_TRUE(found.has_value()) << found.error().message();
  EXPECT_NEAR(found->delay_s, kTruth_s, kTolerance_s);
  EXPECT_LT(found->sigma_s, kTolerance_s);
}

TEST(DelaySearchTest, PartsThatDisagreeMakeItUncertain) {
  constexpr double kScatter_s = 0.003;
  const Result<DelayEstimate> found = SearchDelay(Bowl(kScatter_s), kAnyWeights, kParts, {}, {});
  ASSERT_TRUE(found.has_value()) << found.error().message();
  // Of the mean of eight.
  const double expected_s = kScatter_s / std::sqrt(double{kParts});
  EXPECT_GT(found->sigma_s, 0.5 * expected_s);
  EXPECT_LT(found->sigma_s, 2.0 * expected_s);
  EXPECT_NEAR(found->delay_s, kTruth_s, 4.0 * expected_s);
}

TEST(DelaySearchTest, TooUncertainIsRefused) {
  const Result<DelayEstimate> found = SearchDelay(Bowl(0.015), kAnyWeights, kParts, {}, {});
  ASSERT_FALSE(found.has_value());
  EXPECT_THAT(found.error().message(), HasSubstr("cannot be told"));
}

TEST(DelaySearchTest, WithoutContrastItIsRefused) {
  const Result<DelayEstimate> found = SearchDelay(Bowl(0.0, 0.01), kAnyWeights, kParts, {}, {});
  ASSERT_FALSE(found.has_value());
  EXPECT_THAT(found.error().message(), HasSubstr("thermal contrast"));
}

TEST(DelaySearchTest, ADelayOutsideTheRangeIsRefused) {
  DelaySearchOptions options;
  options.range_s = 0.02;
  const Result<DelayEstimate> found = SearchDelay(Bowl(0.0), kAnyWeights, kParts, options, {});
  ASSERT_FALSE(found.has_value());
  EXPECT_THAT(found.error().message(), HasSubstr("--range"));
}

TEST(DelaySearchTest, AShortScanIsRefused) {
  const Result<DelayEstimate> found = SearchDelay(Bowl(0.0), kAnyWeights, 2, {}, {});
  ASSERT_FALSE(found.has_value());
  EXPECT_THAT(found.error().message(), HasSubstr("scan for longer"));
}

}  // namespace
}  // namespace isotherm
