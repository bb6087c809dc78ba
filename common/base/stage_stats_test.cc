#include "common/base/stage_stats.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

namespace isotherm {
namespace {

constexpr double kRelative = 0.006;  // Half a bin of 1 %, and a little for rounding.

TEST(StageStatsTest, IsZeroBeforeTheFirstCall) {
  const StageStats stats;
  EXPECT_EQ(stats.count(), 0U);
  EXPECT_EQ(stats.Percentile(99), 0.0);
  EXPECT_EQ(stats.mean_ms(), 0.0);
}

TEST(StageStatsTest, PercentilesAgreeWithTheSortedList) {
  constexpr unsigned kSeed = 20240607;
  SCOPED_TRACE(kSeed);
  std::mt19937 random(kSeed);
  std::lognormal_distribution<double> duration_ms(1.0, 1.5);
  StageStats stats;
  std::vector<double> sorted_ms;
  for (int i = 0; i < 5000; ++i) sorted_ms.push_back(duration_ms(random));
  for (const double ms : sorted_ms) stats.Add(ms);
  std::sort(sorted_ms.begin(), sorted_ms.end());
  for (const int percent : {1, 25, 50, 90, 95, 99}) {
    const std::size_t rank = sorted_ms.size() * static_cast<std::size_t>(percent) / 100;
    EXPECT_NEAR(stats.Percentile(percent) / sorted_ms[rank - 1], 1.0, kRelative) << percent;
  }
  EXPECT_EQ(stats.Percentile(100), sorted_ms.back());
  EXPECT_EQ(stats.min_ms(), sorted_ms.front());
}

TEST(StageStatsTest, ExtremeDurationsStayInRange) {
  StageStats stats;
  stats.Add(-1.0);
  stats.Add(std::numeric_limits<double>::quiet_NaN());
  stats.Add(1e12);
  EXPECT_EQ(stats.count(), 3U);
  EXPECT_LE(stats.Percentile(50), 1e-3);
  EXPECT_EQ(stats.Percentile(99), 1e12);
}

}  // namespace
}  // namespace isotherm
