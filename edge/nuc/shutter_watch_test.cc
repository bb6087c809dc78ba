#include "edge/nuc/shutter_watch.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "edge/nuc/testing/supervised_camera.h"

namespace isotherm {
namespace {

using std::chrono::milliseconds;
using testing::ElementsAre;
using testing::HasSubstr;
using S = Shows;

class ShutterWatchTest : public testing::Test {
 protected:
  static NucOptions Options() {
    NucOptions options;
    options.mutable_expert()->set_settle_time_s(0.5);
    options.mutable_expert()->set_max_duration_s(5);
    options.mutable_expert()->set_frozen_restart_s(2);
    options.mutable_expert()->set_commanded_duration_s(1);
    options.mutable_expert()->set_min_interval_s(10);
    options.mutable_expert()->set_max_closings_per_minute(2);
    return options;
  }
  /// Frames at 40 Hz; the time is that of the newest one afterwards.
  void Frames(S shows, double seconds, bool ordered = false) {
    for (double t = 0.0; t < seconds - 1e-9; t += ToSeconds(kPeriod)) {
      now_ += kPeriod;
      shutter_.Update(now_, Observe(shows), ordered);
      shutter_.FollowStorm();
    }
  }
  std::vector<std::string> Notices() {
    std::vector<std::string> texts;
    for (const NucNotice& notice : notices_.Take()) texts.push_back(notice.text);
    return texts;
  }

  NucNotices notices_;
  ShutterWatch shutter_{Options(), notices_};
  CaptureTime now_{std::chrono::hours(1)};
};

TEST_F(ShutterWatchTest, ClosesOpensAndSettles) {
  Frames(S::kScene, 1);
  EXPECT_FALSE(shutter_.is_closed() || shutter_.is_settling(now_));
  Frames(S::kShutFlag, 0.4);
  EXPECT_TRUE(shutter_.is_closed());
  Frames(S::kScene, 0.025);
  EXPECT_TRUE(shutter_.just_opened());
  const CaptureTime opened = now_;
  EXPECT_TRUE(shutter_.is_settling(opened + milliseconds(499)));
  EXPECT_FALSE(shutter_.is_settling(opened + milliseconds(500)));
  EXPECT_THAT(Notices(), ElementsAre("shutter closed, not ordered by us, known by its frames",
                                     "shutter open after 0.40 s, settling for 0.50 s"));
}

TEST_F(ShutterWatchTest, KnowsWhatWasOrdered) {
  Frames(S::kSaysClosed, 0.1, true);
  EXPECT_THAT(Notices(), ElementsAre(HasSubstr("shutter closed as ordered")));
}

TEST_F(ShutterWatchTest, ACameraThatTellsNothingIsClosedForItsTimeAfterAnOrder) {
  Frames(S::kScene, 1);
  EXPECT_FALSE(shutter_.is_reported());
  shutter_.CloseBlindly(now_);
  Frames(S::kScene, 0.95);
  EXPECT_TRUE(shutter_.is_closed());
  EXPECT_EQ(shutter_.log().source(), NucSource::kCommanded);
  Frames(S::kScene, 0.05);
  EXPECT_FALSE(shutter_.is_closed());
}

TEST_F(ShutterWatchTest, ACameraThatReportedOnceIsNotAssessedByUniformImages) {
  Frames(S::kUniform, 0.1);
  EXPECT_TRUE(shutter_.is_closed());
  Frames(S::kSaysIdle, 0.1);
  EXPECT_TRUE(shutter_.is_reported());
  Frames(S::kUniform, 0.1);
  EXPECT_FALSE(shutter_.is_closed());
}

TEST_F(ShutterWatchTest, F08IsStuckAfterLongerThanACorrectionTakesAndSaysSoOnce) {
  Frames(S::kShutFlag, 5.0);
  EXPECT_FALSE(shutter_.is_stuck());
  Frames(S::kShutFlag, 5.0);
  EXPECT_TRUE(shutter_.is_stuck());
  EXPECT_FALSE(shutter_.TakeRestart(now_)) << "the camera is not frozen";
  EXPECT_THAT(Notices(), ElementsAre(HasSubstr("closed"), HasSubstr("does not end")));
}

TEST_F(ShutterWatchTest, F05FrozenFramesAreStuckSoonerAndTheCameraIsRestartedNotTooOften) {
  Frames(S::kFrozen, 2.0);
  EXPECT_FALSE(shutter_.is_stuck());
  Frames(S::kFrozen, 0.1);
  EXPECT_TRUE(shutter_.is_stuck() && shutter_.is_frozen());
  EXPECT_TRUE(shutter_.TakeRestart(now_));
  Frames(S::kFrozen, 9.9);
  EXPECT_FALSE(shutter_.TakeRestart(now_));
  Frames(S::kFrozen, 0.1);
  EXPECT_TRUE(shutter_.TakeRestart(now_));
}

TEST_F(ShutterWatchTest, F08TooManyClosingsAreAStormUntilTheMinuteIsOver) {
  for (int closing = 1; closing <= 3; ++closing) {
    Frames(S::kShutFlag, 0.1);
    EXPECT_EQ(shutter_.is_storm(), closing > 2) << closing;
    Frames(S::kScene, 0.1);
  }
  EXPECT_THAT(shutter_.StormText(), HasSubstr("3 corrections in the last minute, more than 2"));
  Notices();
  Frames(S::kScene, 61);
  EXPECT_FALSE(shutter_.is_storm());
  EXPECT_THAT(Notices(), ElementsAre(HasSubstr("storm is over")));
}

TEST_F(ShutterWatchTest, F08ASingleClosingInAStormIsNotWorthANotice) {
  for (int closing = 0; closing < 3; ++closing) {
    Frames(S::kShutFlag, 0.1);
    Frames(S::kScene, 0.1);
  }
  Notices();
  Frames(S::kShutFlag, 0.1);
  Frames(S::kScene, 0.1);
  EXPECT_THAT(Notices(), testing::IsEmpty());
}

}  // namespace
}  // namespace isotherm
