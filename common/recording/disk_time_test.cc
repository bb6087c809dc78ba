#include "common/recording/disk_time.h"

#include <gtest/gtest.h>

#include <limits>

namespace isotherm {
namespace {

TEST(DiskTimeTest, MinutesThenHoursThenDays) {
  EXPECT_EQ(DiskTimeText(0.0), "disk: 0 min left");
  EXPECT_EQ(DiskTimeText(60.0), "disk: 1 min left");
  EXPECT_EQ(DiskTimeText(119.0 * 60.0), "disk: 119 min left");
  EXPECT_EQ(DiskTimeText(3.0 * 3600.0), "disk: 3 h left");
  EXPECT_EQ(DiskTimeText(101.0 * 3600.0), "disk: days left");
}

TEST(DiskTimeTest, WhatIsNotKnownIsNotSaid) {
  EXPECT_EQ(DiskTimeText(std::numeric_limits<double>::quiet_NaN()), "");
}

}  // namespace
}  // namespace isotherm
