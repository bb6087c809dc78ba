#include "edge/daemon/edge_monitor.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <thread>

#include "common/testing/temporary_directory.h"
#include "edge/options/edge_options.pb.h"
#include "edge/publisher/testing/fake_publisher.h"
#include "edge/source/testing/fake_source.h"

namespace isotherm {
namespace {

using std::chrono::hours;
using std::chrono::milliseconds;
using std::chrono::seconds;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

/// As often as the daemon's main thread looks around.
constexpr milliseconds kTick(50);
constexpr seconds kFeed(5);

/// An edge whose threads are not started: counters and cameras say what the test tells them.
class EdgeMonitorTest : public ::testing::Test {
 protected:
  EdgeMonitorTest() {
    host_status_.disk_free_bytes = 5'000'000;
    host_status_.cpu_temperature_celsius = 61.5;
    host_status_.clock.synchronised = true;
    clock_.Advance(hours(1));
  }

  EdgeMonitor& Make(std::optional<Nanoseconds> watchdog = kFeed) {
    const MonitorHost host = {.read = [this] { return host_status_; },
                              .notify_status =
                                  [this](std::string_view text) {
                                    if (!is_manager_busy_) told_.emplace_back(text);
                                    return !is_manager_busy_;
                                  },
                              .notify_alive = [this] { ++fed_; },
                              .watchdog_interval = watchdog};
    return monitor_.emplace(EdgeMonitorParts{clock_, pipeline_, publisher_, counters_, health_},
                            image_, host);
  }
  /// Time passes, with `frames_per_tick` depth frames.
  void Pass(Nanoseconds time, std::uint64_t frames_per_tick = 0) {
    for (Nanoseconds passed{0}; passed < time; passed += kTick) {
      clock_.Advance(kTick);
      counters_.Count(Sensor::kDepth, FrameFate::kCaptured, frames_per_tick);
      monitor_->Tick();
    }
  }
  EdgeStatus Newest() const { return publisher_.statuses().back(); }

  FakeClock clock_;
  HostStatus host_status_;
  FakeSource source_{"%"};  ///< Nobody reads it before StartCapture.
  FakePublisher publisher_;
  FrameCounters counters_;
  CameraHealth health_;
  EdgePipeline pipeline_{EdgeOptions(), EdgeParts{.source = source_,
                                                  .publisher = publisher_,
                                                  .counters = counters_,
                                                  .health = health_,
                                                  .clock = clock_,
                                                  .spool = nullptr,
                                                  .session = 77,
                                                  .rig_thermal_delay_s = 0.0}};
  const ::isotherm::testing::TemporaryDirectory folder_;
  const std::filesystem::path image_ = folder_.path() / "confidence.png";
  std::optional<EdgeMonitor> monitor_;
  std::vector<std::string> told_;  ///< To the service manager.
  bool is_manager_busy_ = false;
  int fed_ = 0;  ///< Its watchdog, this many times.
};

TEST_F(EdgeMonitorTest, TheStatusIsPublishedOnceASecondHoweverOftenItTicks) {
  Make().Tick();
  EXPECT_EQ(publisher_.statuses().size(), 1U) << "at once";
  Pass(seconds(10));
  EXPECT_EQ(publisher_.statuses().size(), 11U);
  EXPECT_EQ(Newest().scan_state, ScanState::kScanning);
}

TEST_F(EdgeMonitorTest, TheRateIsThatOfTheLastSecond) {
  Make().Tick();
  Pass(seconds(2), 2);  // Each 50 ms.
  EXPECT_DOUBLE_EQ(Newest().depth.rate_hz, 40.0);
  EXPECT_DOUBLE_EQ(Newest().thermal.rate_hz, 0.0);
  Pass(seconds(1), 1);
  EXPECT_DOUBLE_EQ(Newest().depth.rate_hz, 20.0);
  EXPECT_EQ(Newest().depth.captured, 100U);
}

TEST_F(EdgeMonitorTest, TheStatusSaysWhatTheComputerSays) {
  Make().Tick();
  EXPECT_EQ(Newest().disk_free_bytes, 5'000'000U);
  EXPECT_DOUBLE_EQ(Newest().cpu_temperature_celsius, 61.5);
  EXPECT_TRUE(Newest().clock.synchronised);
  host_status_ = {};
  Pass(seconds(1));
  EXPECT_EQ(Newest().disk_free_bytes, 0U) << "not known";
  EXPECT_FALSE(Newest().clock.synchronised);
  host_status_.disk_free_bytes = 0;
  Pass(seconds(1));
  EXPECT_EQ(Newest().disk_free_bytes, 1U) << "none, which is not the same as not known";
}

TEST_F(EdgeMonitorTest, TheLastStatusSaysThatTheScanHasEnded) {
  Make().PublishEnd();
  EXPECT_EQ(Newest().scan_state, ScanState::kEnded);
}

TEST_F(EdgeMonitorTest, ACameraThatIsLostIsToldOnceAndSoIsThatAllIsWellAgain) {
  health_.SetWorks(Sensor::kDepth, true);
  Make().Tick();
  health_.SetWorks(Sensor::kDepth, false);
  Pass(seconds(5));
  EXPECT_THAT(told_, ElementsAre(HasSubstr("the depth camera is lost: look at its cable")));
  EXPECT_EQ(Newest().depth_camera.state, CameraState::kLost);
  health_.SetWorks(Sensor::kDepth, true);
  Pass(seconds(1));
  EXPECT_EQ(told_.size(), 2U);
  EXPECT_EQ(told_.back(), "all is well again");
}

TEST_F(EdgeMonitorTest, AllThatIsWrongIsToldInOneStatus) {
  health_.SetWorks(Sensor::kThermal, false);
  publisher_.SetProblem("no network: wlan0 is missing");
  Make().Tick();
  EXPECT_THAT(told_, ElementsAre(::testing::AllOf(HasSubstr("no network: wlan0 is missing; "),
                                                  HasSubstr("the thermal camera is lost"))));
}

TEST_F(EdgeMonitorTest, WhileAllIsWellTheServiceManagerIsToldTheRatesEachTenSeconds) {
  Make().Tick();
  Pass(seconds(9), 1);
  EXPECT_THAT(told_, IsEmpty());
  Pass(seconds(12), 1);
  ASSERT_EQ(told_.size(), 2U);
  EXPECT_THAT(told_.back(), HasSubstr("20"));
}

TEST_F(EdgeMonitorTest, WhatABusyServiceManagerDidNotTakeIsSaidAgain) {
  is_manager_busy_ = true;
  publisher_.SetProblem("no network");
  Make().Tick();
  Pass(seconds(3));
  EXPECT_THAT(told_, IsEmpty());
  is_manager_busy_ = false;
  Pass(seconds(3));
  EXPECT_THAT(told_, ElementsAre("no network")) << "once";
}

TEST_F(EdgeMonitorTest, WhatIsWrongIsNotReplacedByTheRates) {
  publisher_.SetProblem("no network");
  Make().Tick();
  Pass(seconds(30), 1);
  EXPECT_THAT(told_, ElementsAre("no network"));
}

TEST_F(EdgeMonitorTest, TheWatchdogIsFedAtItsInterval) {
  Make().Tick();
  Pass(seconds(20));
  EXPECT_EQ(fed_, 5) << "at once, and each five seconds";
}

TEST_F(EdgeMonitorTest, F39ACameraThatCountsAsWorkingAndSendsNothingIsNoSignOfLife) {
  health_.SetWorks(Sensor::kDepth, true);
  Make().Tick();
  Pass(seconds(10));
  const int before = fed_;
  Pass(seconds(20));
  EXPECT_EQ(fed_, before);
  Pass(seconds(5), 1);
  EXPECT_EQ(fed_, before + 1) << "it goes on";
}

TEST_F(EdgeMonitorTest, F39WhatIsStuckIsNoSignOfLife) {
  ASSERT_TRUE(source_.Open().ok());
  Make().Tick();
  pipeline_.StartCapture();
  while (!source_.hangs()) std::this_thread::yield();
  Pass(seconds(10));
  const int before = fed_;
  Pass(seconds(20));
  EXPECT_EQ(fed_, before);
  EXPECT_THAT(told_, Contains(HasSubstr("the source of frames does not answer")));
  source_.Release();
  while (pipeline_.StuckIn(clock_.SteadyNow())) std::this_thread::yield();
  Pass(seconds(5));
  EXPECT_EQ(fed_, before + 1) << "it goes on";
}

TEST_F(EdgeMonitorTest, F39ACameraThatIsLookedForIsASignOfLife) {
  health_.SetWorks(Sensor::kDepth, true);
  Make().Tick();
  health_.SetWorks(Sensor::kDepth, false);
  Pass(seconds(60));
  EXPECT_EQ(fed_, 13);
}

TEST_F(EdgeMonitorTest, WithoutAWatchdogNobodyIsTold) {
  Make(std::nullopt).Tick();
  Pass(seconds(30));
  EXPECT_EQ(fed_, 0);
}

TEST_F(EdgeMonitorTest, TheGroundsImageReplacesTheFileAsSoonAsItComes) {
  Feedback feedback;
  feedback.image = {1, 2, 3};
  publisher_.feedback = {{feedback, CaptureTime{}}};
  Make();
  pipeline_.StartReceiving();
  // The pipeline's thread hands it over; only a failure waits this long.
  const auto deadline = std::chrono::steady_clock::now() + seconds(10);
  while (pipeline_.feedback().latency().count == 0) {
    ASSERT_LT(std::chrono::steady_clock::now(), deadline) << "the feedback has not come";
    std::this_thread::yield();
  }
  monitor_->Tick();
  std::ifstream file(image_, std::ios::binary);
  const std::string content{std::istreambuf_iterator<char>(file), {}};
  EXPECT_EQ(content, "\x01\x02\x03");
}

}  // namespace
}  // namespace isotherm
