#include "edge/nuc/warm_up_wait.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "edge/options/edge_options.pb.h"

namespace isotherm {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::Field;
using testing::HasSubstr;

class WarmUpWaitTest : public testing::Test {
 protected:
  WarmUpWait Make(NucOptions::WarmUp mode, bool is_camera = true) {
    NucOptions options;
    options.set_warm_up(mode);
    options.mutable_expert()->set_warm_up_time_s(180);
    return WarmUpWait(options, is_camera, notices_);
  }
  /// At `seconds` after the first frame of a camera that tells no temperature.
  void Update(WarmUpWait& wait, int seconds) {
    wait.Update(start_ + std::chrono::seconds(seconds), {});
  }

  NucNotices notices_;
  const CaptureTime start_{std::chrono::hours(1)};
};

TEST_F(WarmUpWaitTest, WaitsFromTheBeginningUntilTheCameraIsWarm) {
  WarmUpWait wait = Make(NucOptions::WAIT);
  EXPECT_TRUE(wait.is_waiting()) << "not assessed is not warm";
  Update(wait, 0);
  Update(wait, 179);
  EXPECT_TRUE(wait.is_waiting() && wait.is_cold());
  Update(wait, 180);
  EXPECT_FALSE(wait.is_waiting() || wait.is_cold());
  EXPECT_THAT(notices_.Take(),
              ElementsAre(Field(&NucNotice::text, AllOf(HasSubstr("counted as warm in 180 s"),
                                                        HasSubstr("no temperatures are taken"))),
                          Field(&NucNotice::text, "the thermal camera is warm")));
}

TEST_F(WarmUpWaitTest, AWarningIsGivenOnceAndNothingWaits) {
  WarmUpWait wait = Make(NucOptions::WARN);
  for (const int seconds : {0, 1, 179}) Update(wait, seconds);
  EXPECT_TRUE(wait.is_cold());
  EXPECT_FALSE(wait.is_waiting());
  EXPECT_THAT(notices_.Take(),
              ElementsAre(Field(&NucNotice::text, HasSubstr("temperatures may be off"))));
}

TEST_F(WarmUpWaitTest, ACameraThatIsWarmAtOnceIsNotWorthANotice) {
  WarmUpWait wait = Make(NucOptions::WARN);
  ThermalHousekeeping steady;
  steady.fpa_celsius = 35.0F;
  for (int s = 0; s <= 60; ++s) wait.Update(start_ + std::chrono::seconds(s), steady);
  EXPECT_FALSE(wait.is_cold());
  EXPECT_THAT(notices_.Take(), testing::IsEmpty());
}

TEST_F(WarmUpWaitTest, NeitherARecordingNorWhoIgnoresItWaitsOrIsWarned) {
  for (WarmUpWait wait : {Make(NucOptions::IGNORE), Make(NucOptions::WAIT, false)}) {
    Update(wait, 0);
    EXPECT_FALSE(wait.is_waiting() || wait.is_cold());
    EXPECT_THAT(notices_.Take(), testing::IsEmpty());
  }
}

}  // namespace
}  // namespace isotherm
