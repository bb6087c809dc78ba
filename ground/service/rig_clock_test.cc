// Where the ground shows what is known of the rig's clock: status, summary, stats.json, recording.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "common/testing/temporary_directory.h"
#include "ground/service/link_counters.h"
#include "ground/service/scan_recorder.h"
#include "ground/service/status_reporter.h"

namespace isotherm {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;
using ::testing::AllOf;
using ::testing::HasSubstr;

constexpr CaptureTime kTime{seconds(1'700'000'000)};

SessionClock MakeClock() {
  SessionClock clock;
  clock.session = 1;
  clock.time = kTime;
  clock.rig = {.synchronised = true, .estimated_error_s = 0.0001, .max_error_s = 0.002};
  clock.depth_camera.stamp_sigma_s = 0.00005;
  clock.thermal_camera.unsynchronised_frames = 3;
  clock.offset = ClockOffset{0.125, 0.0005};
  clock.largest_offset_s = 0.12;
  clock.alarm = true;
  clock.alarms = 1;
  return clock;
}

TEST(RigClockTest, F18StatsHaveAllOfItWithUnits) {
  SessionCounters counters;
  counters.clock = MakeClock();
  Json link;
  DescribeCounters(counters, {}, link);
  EXPECT_THAT(
      JsonText(link),
      AllOf(HasSubstr("\"synchronised\": true"), HasSubstr("\"estimated_error_ms\": 0.1"),
            HasSubstr("\"max_error_ms\": 2"), HasSubstr("\"steps\": 0"), HasSubstr("\"ms\": 125"),
            HasSubstr("\"uncertainty_ms\": 0.5"), HasSubstr("\"largest_certain_ms\": 120"),
            HasSubstr("\"thermal\": 3"), HasSubstr("\"alarm\": true"), HasSubstr("\"alarms\": 1")));
}

TEST(RigClockTest, F18SummaryAndStatusShowTheAlarm) {
  GroundSituation situation;
  SubscriberStats& stats = situation.link;
  stats.edge_present = true;
  stats.counters.session = 1;
  EXPECT_THAT(StatusText(situation), HasSubstr("rig's clock: unknown"));
  stats.counters.clock = MakeClock();
  EXPECT_THAT(StatusText(situation),
              AllOf(HasSubstr("scanning | CLOCK ALARM | "),
                    HasSubstr("CLOCK ALARM: synchronised, off by about 0.10 ms, at most 2.0 ms, "
                              "125.0 ms ahead of ours (+-0.5 ms); stamps +-0.050 ms depth")));
  EXPECT_THAT(CountersText(stats.counters, {}), HasSubstr("clock    of the rig: CLOCK ALARM"));
}

class ClockRecordTest : public ::testing::Test {
 protected:
  void Record(const std::vector<SessionClock>& clocks) {
    const std::filesystem::path path = folder_.path() / "scan.mcap";
    const FakeClock time(kTime);
    ScanRecorder recorder(path, GroundOptions(), RigDescription(), time);
    recorder.Tend();
    for (const SessionClock& clock : clocks) recorder.Write(clock);
    ASSERT_TRUE(recorder.Close().ok());
    reader_ = std::move(*RecordingReader::Open(path));
  }
  const std::map<std::string, std::string>& Metadata() const {
    return reader_->info().metadata.at("clock");
  }
  std::vector<ClockStep> Steps() {
    std::vector<ClockStep> steps;
    while (const auto item = *reader_->Next()) {
      if (const auto* step = std::get_if<ClockStep>(&*item)) steps.push_back(*step);
    }
    return steps;
  }

  testing::TemporaryDirectory folder_;
  std::unique_ptr<RecordingReader> reader_;
};

TEST_F(ClockRecordTest, F17OnceUnsynchronisedIsUnsynchronised) {
  SessionClock clock;
  clock.time = kTime;
  clock.unsynchronised = true;
  SessionClock later = MakeClock();
  later.unsynchronised = true;
  Record({clock, later});
  EXPECT_EQ(Metadata().at("synchronised"), "no");
  EXPECT_EQ(Metadata().at("minus_ground_clock_s"), "0.125");
  EXPECT_EQ(Metadata().at("alarms"), "1");
}

TEST_F(ClockRecordTest, F15EachStepIsAnEventOnTheTimeLineOfTheFrames) {
  SessionClock clock = MakeClock();
  SessionClock stepped = clock;
  stepped.rig.steps = 1;
  stepped.rig.step_sum_s = -3.0;
  stepped.time = kTime + seconds(1) - seconds(3);  // The rig's clock went back.
  SessionClock again = stepped;
  again.time += seconds(1);
  Record({clock, stepped, again});
  EXPECT_EQ(Metadata().at("synchronised"), "yes");
  EXPECT_EQ(Metadata().at("steps"), "1");
  const std::vector<ClockStep> steps = Steps();
  ASSERT_EQ(steps.size(), 1U);
  EXPECT_EQ(steps[0].time, kTime + seconds(1));
  EXPECT_EQ(steps[0].step, -seconds(3));
  EXPECT_EQ(steps[0].wall_minus_time, -seconds(3));
}

TEST(StatusReporterTest, TellsEveryTenSecondsWhileAScanRuns) {
  FakeClock clock(kTime);
  StatusReporter reporter(clock);
  GroundSituation situation;
  situation.link.counters.session = 1;
  ::testing::internal::CaptureStderr();
  for (int i = 0; i < 21; ++i) {
    reporter.Report(situation);
    clock.Advance(milliseconds(1000));
  }
  situation.link.counters.closed = true;
  for (int i = 0; i < 21; ++i) {
    reporter.Report(situation);
    clock.Advance(milliseconds(1000));
  }
  const std::string told = ::testing::internal::GetCapturedStderr();
  EXPECT_EQ(std::count(told.begin(), told.end(), '\n'), 2) << told;
}

}  // namespace
}  // namespace isotherm
