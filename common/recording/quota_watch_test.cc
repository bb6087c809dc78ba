#include "common/recording/quota_watch.h"

#include <gtest/gtest.h>

namespace isotherm {
namespace {

using std::chrono::seconds;

TEST(QuotaWatchTest, WhatIsWrittenMeanwhileCounts) {
  std::uint64_t size = 400;
  int asked = 0;
  QuotaWatch watch(1e-6, [&] {
    ++asked;
    return size;
  });
  EXPECT_EQ(watch.Left(SteadyTime(seconds(1)), 50), 600U) << "of 1000 bytes";
  EXPECT_EQ(watch.Left(SteadyTime(seconds(2)), 150), 500U);
  EXPECT_EQ(watch.Left(SteadyTime(seconds(3)), 5000), 0U);
  EXPECT_EQ(asked, 1) << "folders are not read through at each frame";
  size = 100;
  EXPECT_EQ(watch.Left(SteadyTime(seconds(12)), 5000), 900U);
  watch.AskAgain();
  size = 0;
  EXPECT_EQ(watch.Left(SteadyTime(seconds(13)), 5000), 1000U);
  EXPECT_EQ(watch.Left(SteadyTime(seconds(13)), 10), 1000U) << "another recording";
  EXPECT_EQ(asked, 4);
}

TEST(QuotaWatchTest, WithoutAQuotaNobodyIsAsked) {
  QuotaWatch watch(0.0, []() -> std::uint64_t {
    ADD_FAILURE();
    return 0;
  });
  EXPECT_EQ(watch.Left(SteadyTime(), 1'000'000), QuotaWatch::kNoQuota);
}

TEST(QuotaWatchTest, WhatCannotBeFoundOutIsAsItWas) {
  std::optional<std::uint64_t> size = 400;
  QuotaWatch watch(1e-6, [&] { return size; });
  EXPECT_EQ(watch.Left(SteadyTime(seconds(1)), 0), 600U);
  size.reset();
  EXPECT_EQ(watch.Left(SteadyTime(seconds(20)), 100), 500U);
  EXPECT_EQ(watch.Left(SteadyTime(seconds(40)), 200), 400U);
}

}  // namespace
}  // namespace isotherm
