#include "edge/nuc/nuc_hold.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "edge/options/edge_options.pb.h"

namespace isotherm {
namespace {

using std::chrono::seconds;
using testing::ElementsAre;
using testing::Field;
using testing::HasSubstr;

class NucHoldTest : public testing::Test {
 protected:
  static NucOptions Options() {
    NucOptions options;
    options.mutable_expert()->set_max_hold_s(60);
    return options;
  }

  NucNotices notices_;
  NucHold hold_{Options(), notices_};
  const CaptureTime start_{std::chrono::hours(1)};
};

TEST_F(NucHoldTest, LastsAsLongAsAskedForAndNotAFrameLonger) {
  EXPECT_EQ(hold_.Hold(start_, 20).value(), "corrections are held for 20 s");
  hold_.Update(start_ + seconds(20) - Nanoseconds(1), "");
  EXPECT_TRUE(hold_.is_held());
  EXPECT_EQ(hold_.left(start_ + seconds(5)), seconds(15));
  hold_.Update(start_ + seconds(20), "");
  EXPECT_FALSE(hold_.is_held());
}

TEST_F(NucHoldTest, IsBoundedHoweverLongIsAskedFor) {
  for (const double asked_s : {61.0, 1e30, std::numeric_limits<double>::infinity()}) {
    EXPECT_THAT(hold_.Hold(start_, asked_s).value(), HasSubstr("for 60 s, the most"));
    EXPECT_EQ(hold_.left(start_), seconds(60)) << asked_s;
  }
}

TEST_F(NucHoldTest, ARenewedOneCountsFromTheFirst) {
  ASSERT_TRUE(hold_.Hold(start_, 50).has_value());
  ASSERT_TRUE(hold_.Hold(start_ + seconds(40), 50).has_value());
  EXPECT_EQ(hold_.left(start_ + seconds(40)), seconds(20));
}

TEST_F(NucHoldTest, AfterOneThatPutACorrectionOffThatOneComesFirst) {
  ASSERT_TRUE(hold_.Hold(start_, 1).has_value());
  hold_.Update(start_ + seconds(1), "asked for");
  EXPECT_EQ(hold_.Hold(start_ + seconds(2), 1).error().code(), StatusCode::kFailedPrecondition);
  hold_.OnCorrected();
  EXPECT_TRUE(hold_.Hold(start_ + seconds(3), 1).has_value());
}

TEST_F(NucHoldTest, AfterOneThatPutNothingOffTheNextMayComeAtOnce) {
  ASSERT_TRUE(hold_.Hold(start_, 1).has_value());
  hold_.Update(start_ + seconds(1), "");
  EXPECT_TRUE(hold_.Hold(start_ + seconds(1), 1).has_value());
}

TEST_F(NucHoldTest, ZeroSecondsEndItAndItsTimeIsNotUsedUp) {
  ASSERT_TRUE(hold_.Hold(start_, 50).has_value());
  EXPECT_EQ(hold_.Hold(start_ + seconds(40), 0).value(), "corrections are not held");
  EXPECT_FALSE(hold_.is_held());
  ASSERT_TRUE(hold_.Hold(start_ + seconds(41), 60).has_value());
  EXPECT_EQ(hold_.left(start_ + seconds(41)), seconds(60));
}

TEST_F(NucHoldTest, WhatIsNoTimeIsRefused) {
  for (const double asked_s : {-1.0, std::numeric_limits<double>::quiet_NaN()}) {
    EXPECT_EQ(hold_.Hold(start_, asked_s).error().code(), StatusCode::kInvalidArgument);
    EXPECT_FALSE(hold_.is_held());
  }
}

TEST_F(NucHoldTest, ItsBeginningAndItsEndAreNoted) {
  ASSERT_TRUE(hold_.Hold(start_, 1).has_value());
  hold_.Update(start_ + seconds(1), "asked for");
  EXPECT_THAT(notices_.Take(),
              ElementsAre(Field(&NucNotice::text, "corrections are held for 1 s"),
                          Field(&NucNotice::text, "hold is over; due: asked for")));
}

}  // namespace
}  // namespace isotherm
