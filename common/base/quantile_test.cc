#include "common/base/quantile.h"

#include <gtest/gtest.h>

#include <random>

namespace isotherm {
namespace {

TEST(QuantileTest, IsTheSortedValueAtTheRank) {
  constexpr unsigned kSeed = 3;
  std::mt19937 random(kSeed);
  std::uniform_real_distribution<double> values(-5.0, 5.0);
  for (const std::size_t count : {1U, 2U, 3U, 10U, 101U}) {
    std::vector<double> sample(count);
    for (double& value : sample) value = values(random);
    std::vector<double> sorted = sample;
    std::ranges::sort(sorted);
    EXPECT_EQ(TakeQuantile(sample, 0.0), sorted.front()) << count;
    EXPECT_EQ(TakeQuantile(sample, 1.0), sorted.back()) << count;
    EXPECT_EQ(TakeMedian(sample), sorted[count / 2]) << count;
    EXPECT_EQ(TakeQuantile(sample, 0.95), sorted[(count - 1) * 95 / 100]) << count;
  }
}

}  // namespace
}  // namespace isotherm
