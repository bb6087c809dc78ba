// Somebody sets the edge's wall clock during a scan, and capture times go on as before.

#include <gtest/gtest.h>

#include <map>
#include <thread>

#include "common/base/mutex.h"
#include "edge/options/edge_options.pb.h"
#include "edge/pipeline/camera_health.h"
#include "edge/pipeline/edge_pipeline.h"
#include "edge/publisher/testing/fake_publisher.h"
#include "edge/source/supervised_source.h"
#include "edge/spool/testing/fake_recording_writer.h"

namespace isotherm {
namespace {

using std::chrono::microseconds;
using std::chrono::milliseconds;
using std::chrono::seconds;

constexpr CaptureTime kStart{seconds(1'700'000'000)};
constexpr microseconds kPeriod{33'333};
constexpr int kFrames = 150;
constexpr int kStepAt = 60;

/// A clock whose wall time can be set.
class SettableClock final : public Clock {
 public:
  explicit SettableClock(CaptureTime start) : wall_(start) {}
  CaptureTime Now() const override {
    MutexLock lock(mutex_);
    return wall_;
  }
  SteadyTime SteadyNow() const override {
    MutexLock lock(mutex_);
    return steady_;
  }
  void Advance(Nanoseconds duration) {
    MutexLock lock(mutex_);
    wall_ += duration;
    steady_ += duration;
  }
  void Step(Nanoseconds step) {
    MutexLock lock(mutex_);
    wall_ += step;
  }

 private:
  mutable Mutex mutex_;
  CaptureTime wall_ GUARDED_BY(mutex_);
  SteadyTime steady_ GUARDED_BY(mutex_){seconds(1'000)};
};

/// A camera whose frames arrive without jitter. Before some of them the wall clock is set.
class SteppedCamera final : public FrameSource {
 public:
  SteppedCamera(SettableClock& clock, std::map<int, Nanoseconds> steps, bool has_device_clock)
      : clock_(clock), steps_(std::move(steps)), has_device_clock_(has_device_clock) {}

  std::string_view name() const override { return "stepped camera"; }
  Status Open() override { return OkStatus(); }
  void Close() override {}
  Result<SourceItem> Read(std::stop_token /*stop*/) override {
    if (frame_ == kFrames) return EndOfStream{};
    if (const auto step = steps_.find(frame_); step != steps_.end()) clock_.Step(step->second);
    clock_.Advance(kPeriod);
    RawFrame frame;
    frame.sensor = Sensor::kDepth;
    frame.frame_number = static_cast<std::uint64_t>(frame_);
    frame.device_ticks = DeviceTicks(frame_ * kPeriod);
    frame.has_device_clock = has_device_clock_;
    frame.arrival_wall = clock_.Now();
    frame.arrival_steady = clock_.SteadyNow();
    frame.pixels = Image<std::uint16_t>(8, 6, 1000);
    ++frame_;
    return SourceItem(std::move(frame));
  }

 private:
  SettableClock& clock_;
  const std::map<int, Nanoseconds> steps_;
  const bool has_device_clock_;
  int frame_ = 0;
};

class ClockStepTest : public testing::Test {
 protected:
  void Run(std::map<int, Nanoseconds> steps, bool has_device_clock = true) {
    EdgeOptions options;
    options.mutable_source()->set_kind(CAMERAS);
    options.mutable_source()->set_rate(0);
    SupervisedSource source(
        std::make_unique<SteppedCamera>(clock_, std::move(steps), has_device_clock),
        options.frame_check(), clock_,
        [this](Sensor sensor) { counters_.Count(sensor, FrameFate::kCaptured); },
        [this](Sensor sensor) { counters_.Count(sensor, FrameFate::kRejected); }, Nanoseconds(0));
    ASSERT_TRUE(source.Open().ok());
    EdgePipeline pipeline(
        options, EdgeParts{.source = source,
                           .publisher = publisher_,
                           .counters = counters_,
                           .health = health_,
                           .clock = clock_,
                           .spool = MakeFakeSpool(recording_, options.spool(), clock_, counters_),
                           .session = 1});
    pipeline.StartReceiving();
    pipeline.StartCapture();
    while (!pipeline.finished()) std::this_thread::yield();
    ASSERT_TRUE(pipeline.Stop().ok());
    steps_ = pipeline.clock_steps();
    total_ = pipeline.clock_step_total();
    unsynchronised_ = health_.Get(Sensor::kDepth).unsynchronised_frames;
  }
  /// Every frame has the time it would have had without the steps.
  void ExpectUntouchedTimes() {
    const std::vector<EncodedDepthFrame> frames = publisher_.depth();
    ASSERT_EQ(frames.size(), static_cast<std::size_t>(kFrames));
    for (int i = 0; i < kFrames; ++i) {
      EXPECT_EQ(ToNanoseconds(frames[static_cast<std::size_t>(i)].header.capture_time),
                ToNanoseconds(kStart + (i + 1) * kPeriod))
          << i;
    }
    EXPECT_EQ(unsynchronised_, 0U);
  }

  SettableClock clock_{kStart};
  FakeRecording recording_;
  FakePublisher publisher_;
  FrameCounters counters_;
  CameraHealth health_;
  std::uint64_t steps_ = 0;
  Nanoseconds total_{0};
  std::uint64_t unsynchronised_ = 0;
};

class F15StepTest : public ClockStepTest, public testing::WithParamInterface<std::int64_t> {};

TEST_P(F15StepTest, OrderAndSpacingStayAndTheStepIsReportedOnce) {
  Run({{kStepAt, seconds(GetParam())}});
  ExpectUntouchedTimes();
  EXPECT_EQ(steps_, 1U);
  EXPECT_EQ(total_, seconds(GetParam()));
}

TEST_P(F15StepTest, TheRecordingChangesItsUtcOnceWithAnEvent) {
  constexpr seconds kInTime{2};  // Row F15.
  Run({{kStepAt, seconds(GetParam())}});
  ASSERT_EQ(recording_.clock_steps.size(), 1U);
  const ClockStep& step = recording_.clock_steps.front();
  EXPECT_EQ(step.step, seconds(GetParam()));
  EXPECT_EQ(step.wall_minus_time, seconds(GetParam()));
  const CaptureTime stepped = kStart + kStepAt * kPeriod;
  EXPECT_GE(step.time, stepped);
  EXPECT_LE(step.time, stepped + kInTime);
}

TEST_P(F15StepTest, WithoutADeviceClockToo) {
  Run({{kStepAt, seconds(GetParam())}}, /*has_device_clock=*/false);
  ExpectUntouchedTimes();
  EXPECT_EQ(steps_, 1U);
}

INSTANTIATE_TEST_SUITE_P(Seconds, F15StepTest,
                         testing::Values(1, -1, 3600, -3600, 100'000'000, -100'000'000));

TEST_F(ClockStepTest, F16ALeapSecondMakesNoDoubleOrNegativeInterval) {
  Run({{kStepAt, -seconds(1)}});
  ExpectUntouchedTimes();
  EXPECT_EQ(total_, -seconds(1));
}

TEST_F(ClockStepTest, F17AScanBegunWithoutTimeGoesOnWhenTimeComes) {
  clock_.Step(-kStart.time_since_epoch());  // 1970: no time at boot, no battery.
  Run({{kStepAt, kStart.time_since_epoch()}});
  const std::vector<EncodedDepthFrame> frames = publisher_.depth();
  ASSERT_EQ(frames.size(), static_cast<std::size_t>(kFrames));
  for (std::size_t i = 1; i < frames.size(); ++i) {
    EXPECT_EQ(frames[i].header.capture_time - frames[i - 1].header.capture_time, kPeriod) << i;
  }
  EXPECT_EQ(steps_, 1U);
  EXPECT_EQ(total_, kStart.time_since_epoch());
}

TEST_F(ClockStepTest, F15SeveralStepsAddUp) {
  Run({{30, seconds(5)}, {60, -seconds(2)}, {90, milliseconds(20)}});
  ExpectUntouchedTimes();
  EXPECT_EQ(steps_, 3U);
  EXPECT_EQ(total_, milliseconds(3020));
}

}  // namespace
}  // namespace isotherm
