#include "edge/spool/disk_watch.h"

#include <gtest/gtest.h>

#include "edge/options/edge_options.pb.h"

namespace isotherm {
namespace {

using std::chrono::seconds;

constexpr std::uint64_t kMb = 1'000'000;
constexpr std::uint64_t kGb = 1000 * kMb;
constexpr double kMinute_s = 60.0;

/// A recording that grows by `mb_per_s` for `duration`, on a disk with this much free at its end.
class DiskWatchTest : public testing::Test {
 protected:
  DiskLevel Record(std::uint64_t mb_per_s, int duration_s, std::uint64_t free_bytes,
                   std::uint64_t quota_bytes = QuotaWatch::kNoQuota,
                   std::uint64_t deletable_bytes = 0) {
    DiskLevel level{};
    for (int i = 0; i < duration_s; ++i) {
      level = watch_.Update(now_, {free_bytes, quota_bytes, deletable_bytes}, recorded_, is_ended_);
      now_ += seconds(1);
      recorded_ += mb_per_s * kMb;
    }
    return level;
  }

  DiskWatch watch_{SpoolOptions()};
  SteadyTime now_{};
  std::uint64_t recorded_ = 0;
  bool is_ended_ = false;
};

TEST_F(DiskWatchTest, F41TenMinutesBeforeTheReserveItIsLow) {
  // 5 MB/s: the reserve is two minutes of it, 600 MB.
  EXPECT_EQ(Record(5, 10, 600 * kMb + 11 * 60 * 5 * kMb), DiskLevel::kEnough);
  EXPECT_DOUBLE_EQ(watch_.left_s(), 11 * kMinute_s);
  EXPECT_EQ(Record(5, 10, 600 * kMb + 9 * 60 * 5 * kMb), DiskLevel::kLow);
  EXPECT_DOUBLE_EQ(watch_.left_s(), 9 * kMinute_s);
}

TEST_F(DiskWatchTest, F41TheReserveIsTwoMinutesOrAGigabyteWhicheverIsLess) {
  EXPECT_EQ(Record(5, 10, 601 * kMb), DiskLevel::kLow);
  EXPECT_EQ(Record(5, 1, 600 * kMb), DiskLevel::kReserve);
  DiskWatch fast{SpoolOptions()};
  for (int i = 0; i < 10; ++i)
    fast.Update(SteadyTime(seconds(i)), {100 * kGb}, static_cast<std::uint64_t>(i) * 50 * kMb,
                false);
  EXPECT_DOUBLE_EQ(fast.reserve_bytes(), 1e9) << "two minutes would be 6 GB";
}

TEST_F(DiskWatchTest, F41AtTheReserveItTakesTwiceTheReserveToGoOn) {
  EXPECT_EQ(Record(5, 10, 500 * kMb), DiskLevel::kReserve);
  EXPECT_EQ(Record(0, 1, 1100 * kMb), DiskLevel::kLow) << "a recording that has not ended goes on";
  is_ended_ = true;
  EXPECT_EQ(Record(0, 1, 1100 * kMb), DiskLevel::kReserve);
  EXPECT_EQ(Record(0, 1, 1300 * kMb), DiskLevel::kLow);
}

TEST_F(DiskWatchTest, BeforeTheRateIsKnownNothingIsSaid) {
  EXPECT_EQ(Record(5, 5, 1 * kMb), DiskLevel::kEnough);
  EXPECT_FALSE(watch_.left_s() >= 0.0);
}

TEST_F(DiskWatchTest, APauseOfTheCamerasDoesNotMakeTheDiskLarger) {
  Record(5, 10, 2 * kGb);
  const double before_s = watch_.left_s();
  Record(0, 60, 2 * kGb);
  EXPECT_NEAR(watch_.left_s(), before_s, 0.5 * before_s);
  EXPECT_EQ(Record(0, 1, 500 * kMb), DiskLevel::kReserve);
}

TEST_F(DiskWatchTest, TheQuotaHasNoReserve) {
  EXPECT_EQ(Record(5, 10, 100 * kGb, 9 * 60 * 5 * kMb), DiskLevel::kLow);
  EXPECT_TRUE(watch_.is_quota_first());
  EXPECT_DOUBLE_EQ(watch_.left_s(), 9 * kMinute_s);
  EXPECT_EQ(Record(5, 1, 100 * kGb, 1 * kMb), DiskLevel::kLow);
  EXPECT_EQ(Record(5, 1, 100 * kGb, 0), DiskLevel::kReserve);
  is_ended_ = true;
  EXPECT_EQ(Record(0, 1, 100 * kGb, 49 * kMb), DiskLevel::kReserve) << "it would end soon again";
  EXPECT_EQ(Record(0, 1, 100 * kGb, 51 * kMb), DiskLevel::kLow);
  Record(5, 1, 700 * kMb, 700 * kMb);
  EXPECT_FALSE(watch_.is_quota_first()) << "the disk is full but for its reserve before";
}

TEST_F(DiskWatchTest, AQuotaThatIsUsedUpNeedsNoRate) {
  EXPECT_EQ(Record(0, 1, 100 * kGb, 0), DiskLevel::kReserve);
  EXPECT_TRUE(watch_.is_quota_first());
  EXPECT_EQ(Record(0, 1, 100 * kGb, 1 * kMb), DiskLevel::kEnough) << "something was deleted";
}

TEST_F(DiskWatchTest, WhatMayBeDeletedIsTimeAsWell) {
  EXPECT_EQ(Record(5, 10, 100 * kGb, 10 * kMb, 11 * 60 * 5 * kMb), DiskLevel::kEnough);
  EXPECT_DOUBLE_EQ(watch_.left_s(), 11 * kMinute_s + 2.0);
  EXPECT_EQ(Record(5, 1, 100 * kGb, 0, 11 * 60 * 5 * kMb), DiskLevel::kReserve)
      << "it must be deleted first";
}

}  // namespace
}  // namespace isotherm
