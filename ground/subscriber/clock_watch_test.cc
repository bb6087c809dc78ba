#include "ground/subscriber/clock_watch.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

namespace isotherm {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;
using testing::HasSubstr;
using testing::Not;

constexpr KernelClock kOwn{
    .synchronised = true, .offset_s = 0.0, .estimated_error_s = 0.0001, .max_error_s = 0.001};
// Row F18: an alarm beyond 50 ms within 10 s. A status comes every second.
constexpr milliseconds kAllowed{50};
constexpr int kStatusesInTime = 10;

class ClockWatchTest : public testing::Test {
 protected:
  ClockWatchTest() {
    status_.session = 7;
    status_.clock.synchronised = true;
  }
  void Update(const std::optional<ClockOffset>& offset) {
    now_ += seconds(1);
    watch_.Update(status_, offset, kOwn, now_);
  }
  const SessionClock& clock() const { return watch_.clock(); }

  ClockWatch watch_{kAllowed};
  EdgeStatus status_;
  SteadyTime now_{seconds(100)};
};

TEST_F(ClockWatchTest, F18ADifferenceThatIsCertainIsAnAlarm) {
  Update(ClockOffset{-0.051, 0.0005});
  EXPECT_TRUE(clock().alarm);
  EXPECT_EQ(clock().alarms, 1U);
  EXPECT_NEAR(clock().largest_offset_s, 0.0505, 1e-9);
  EXPECT_THAT(ClockText(clock()), HasSubstr("CLOCK ALARM"));
  EXPECT_THAT(ClockText(clock()), HasSubstr("51.0 ms behind ours (+-0.5 ms)"));
}

TEST_F(ClockWatchTest, F18ASlowLinkAloneIsNoAlarm) {
  for (int i = 0; i < 100; ++i) Update(ClockOffset{0.19, 0.2});
  EXPECT_FALSE(clock().alarm);
  EXPECT_EQ(clock().alarms, 0U);
  EXPECT_EQ(clock().largest_offset_s, 0.0) << "nothing is certain";
}

TEST_F(ClockWatchTest, F18TheAlarmEndsWhenTheClockIsRightAgain) {
  Update(ClockOffset{0.2, 0.001});
  Update(ClockOffset{0.060, 0.020});
  EXPECT_TRUE(clock().alarm) << "less certain, but not better";
  Update(ClockOffset{0.010, 0.001});
  EXPECT_FALSE(clock().alarm);
  EXPECT_EQ(clock().alarms, 1U);
  EXPECT_NEAR(clock().largest_offset_s, 0.199, 1e-9) << "of the whole session";
}

TEST_F(ClockWatchTest, F18TheAlarmIsToldAtMostOnceAMinute) {
  testing::internal::CaptureStderr();
  for (int i = 0; i < 59; ++i) Update(ClockOffset{i % 2 == 0 ? 0.2 : 0.0, 0.001});
  const std::string told = testing::internal::GetCapturedStderr();
  std::size_t lines = 0;
  for (auto at = told.find("CLOCK ALARM"); at != std::string::npos;
       at = told.find("CLOCK ALARM", at + 1)) {
    ++lines;
  }
  EXPECT_EQ(lines, 1U) << told;
  EXPECT_THAT(told, HasSubstr("live.expert.max_clock_offset_s"));
  EXPECT_THAT(told, HasSubstr("agrees with ours again"));
  EXPECT_EQ(clock().alarms, 30U) << "counted all the same";
}

TEST_F(ClockWatchTest, F18NoAlarmIfNoneIsWanted) {
  watch_ = ClockWatch(Nanoseconds(0));
  Update(ClockOffset{3600.0, 0.001});
  EXPECT_FALSE(clock().alarm);
  EXPECT_NEAR(clock().largest_offset_s, 3600.0, 0.01);
}

TEST_F(ClockWatchTest, AnAlarmOutlivesItsSession) {
  Update(ClockOffset{0.2, 0.001});
  status_.session = 8;
  Update(std::nullopt);
  EXPECT_EQ(clock().session, 8U);
  EXPECT_TRUE(clock().alarm);
  EXPECT_EQ(clock().alarms, 1U);
  EXPECT_TRUE(std::isnan(clock().largest_offset_s));
}

TEST_F(ClockWatchTest, F17AnUnsynchronisedRigIsToldAndRemembered) {
  status_.clock = {};
  testing::internal::CaptureStderr();
  Update(std::nullopt);
  Update(std::nullopt);
  const std::string told = testing::internal::GetCapturedStderr();
  EXPECT_EQ(told.find("not synchronised"), told.rfind("not synchronised")) << "once";
  EXPECT_THAT(told, HasSubstr("docs/timing.md"));
  EXPECT_THAT(ClockText(clock()), HasSubstr("not synchronised"));
  status_.clock.synchronised = true;
  Update(std::nullopt);
  EXPECT_TRUE(clock().unsynchronised);
  EXPECT_THAT(ClockText(clock()), HasSubstr("synchronised (not all the time)"));
}

TEST_F(ClockWatchTest, F15AStepIsToldOnce) {
  Update(std::nullopt);
  status_.clock.steps = 1;
  status_.clock.step_sum_s = -3.0;
  testing::internal::CaptureStderr();
  Update(std::nullopt);
  Update(std::nullopt);
  const std::string told = testing::internal::GetCapturedStderr();
  EXPECT_THAT(told, HasSubstr("set by -3.000 s"));
  EXPECT_EQ(told.find("set by"), told.rfind("set by")) << told;
  EXPECT_THAT(ClockText(clock()), HasSubstr("set 1 time by -3.000 s in all"));
}

TEST_F(ClockWatchTest, StampsAreShownWithTheirUncertainty) {
  status_.depth_camera.stamp_sigma_s = 0.00005;
  status_.thermal_camera.stamp_sigma_s = 0.00012;
  Update(std::nullopt);
  EXPECT_THAT(ClockText(clock()), HasSubstr("stamps +-0.050 ms depth, +-0.120 ms thermal"));
  EXPECT_THAT(ClockText(clock()), Not(HasSubstr("UNSYNCHRONISED frames")));
  status_.thermal_camera.unsynchronised_frames = 4;
  Update(std::nullopt);
  EXPECT_THAT(ClockText(clock()), HasSubstr("UNSYNCHRONISED frames 0 depth, 4 thermal"));
}

/// Rig and ground with a link between them: row F18 as a whole.
class F18Test : public testing::Test {
 protected:
  /// Returns the statuses until the alarm, at most `max_statuses`; nullopt if there was none.
  std::optional<int> AlarmAfter(Nanoseconds rig_ahead, Nanoseconds there, Nanoseconds back,
                                int max_statuses) {
    EdgeStatus status;
    for (int i = 1; i <= max_statuses; ++i) {
      const std::uint64_t ping = comparison_.Ping(SteadyTime(elapsed_));
      ClockEcho echo{.ping = ping, .received = Wall(there + rig_ahead), .sent = {}};
      elapsed_ += seconds(1);
      echo.sent = Wall(rig_ahead);
      elapsed_ += back;
      const SteadyTime now(elapsed_);
      comparison_.Add(echo, now);
      watch_.Update(status, comparison_.Offset({Wall(), now}), kOwn, now);
      if (watch_.clock().alarm) return i;
    }
    return std::nullopt;
  }
  CaptureTime Wall(Nanoseconds more = {}) const {
    return CaptureTime(seconds(1'700'000'000)) + elapsed_ + more;
  }

  ClockComparison comparison_{1};
  ClockWatch watch_{kAllowed};
  Nanoseconds elapsed_{seconds(100)};
};

TEST_F(F18Test, AWrongClockIsFoundInTimeOverAnyUsableLink) {
  for (const int ahead_ms : {-3'600'000, -250, -80, 80, 250, 3'600'000}) {
    for (const auto& [there, back] : {std::pair(1, 1), {25, 2}, {2, 25}}) {
      comparison_ = ClockComparison(1);
      watch_ = ClockWatch(kAllowed);
      const auto after =
          AlarmAfter(milliseconds(ahead_ms), milliseconds(there), milliseconds(back), 60);
      ASSERT_TRUE(after.has_value()) << ahead_ms << " ms";
      EXPECT_LE(*after, kStatusesInTime);
    }
  }
}

TEST_F(F18Test, ARightClockBehindASlowAndLopsidedLinkIsNoAlarm) {
  for (const auto& [there, back] : {std::pair(400, 1), {1, 400}, {2000, 10}, {10, 2000}}) {
    comparison_ = ClockComparison(1);
    EXPECT_EQ(AlarmAfter(Nanoseconds(0), milliseconds(there), milliseconds(back), 60),
              std::nullopt);
  }
}

TEST_F(F18Test, ATimeServerThatGoesWrongDuringTheScanIsFoundInTime) {
  EXPECT_EQ(AlarmAfter(milliseconds(5), milliseconds(2), milliseconds(1), 30), std::nullopt);
  const auto after = AlarmAfter(milliseconds(120), milliseconds(2), milliseconds(1), 30);
  ASSERT_TRUE(after.has_value());
  EXPECT_LE(*after, kStatusesInTime);
}

}  // namespace
}  // namespace isotherm
