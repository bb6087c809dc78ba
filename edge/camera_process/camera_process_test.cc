// A camera in a process of its own, with a real process whose "library" crashes or hangs when it is
// told to.

#include "edge/camera_process/camera_process.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <stop_token>
#include <thread>

#include "edge/camera_process/testing/fake_process.h"
#include "edge/camera_process/testing/process_holder.h"
#include "edge/options/edge_options.pb.h"

namespace isotherm {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;
using ::testing::HasSubstr;

constexpr seconds kPatience{20};
/// A daemon that is told to stop may take this long in all.
constexpr seconds kPromptly{2};

class CameraProcessTest : public ::testing::Test {
 protected:
  void Make(const std::string& what, int after_frames = 0) {
    camera_ = std::make_unique<CameraProcess>(Fake(what, after_frames), clock_);
  }
  /// The next frame, failure or end.
  Result<SourceItem> Next() {
    const SteadyTime end = clock_.SteadyNow() + kPatience;
    while (clock_.SteadyNow() < end) {
      Result<SourceItem> item = camera_->Read({});
      if (!item || !std::holds_alternative<NothingYet>(*item)) return item;
    }
    return Err(Internal("neither a frame nor a failure"));
  }
  RawFrame NextFrame() {
    Result<SourceItem> item = Next();
    if (item && std::holds_alternative<RawFrame>(*item)) return std::get<RawFrame>(*item);
    ADD_FAILURE() << (item ? "no frame" : item.error().message());
    return {};
  }
  /// Reads until it fails.
  Status Failure() {
    while (true) {
      const Result<SourceItem> item = Next();
      if (!item) return item.error();
    }
  }

  const SystemClock clock_{};
  std::unique_ptr<CameraProcess> camera_;
};

TEST_F(CameraProcessTest, FramesArriveAsTheyWere) {
  Make("go-on");
  const SteadyTime before = clock_.SteadyNow();
  ASSERT_TRUE(camera_->Open().ok());
  NextFrame();
  const RawFrame frame = NextFrame();
  EXPECT_EQ(frame.sensor, Sensor::kThermal);
  EXPECT_EQ(frame.frame_number, 1U);
  EXPECT_EQ(frame.device_ticks.time_since_epoch().count(), 3000);
  EXPECT_FALSE(frame.has_device_clock);
  EXPECT_GT(frame.arrival_steady, before) << "both processes have the same clock";
  EXPECT_LE(frame.arrival_steady, clock_.SteadyNow());
  EXPECT_LE(frame.arrival_wall, clock_.Now());
  ASSERT_EQ(frame.pixels.width(), 5);
  ASSERT_EQ(frame.pixels.height(), 3);
  for (std::size_t i = 0; i < 15; ++i) EXPECT_EQ(frame.pixels.data()[i], 1000 * i + 1);
  EXPECT_EQ(frame.depth_scale, 10'000.0);
  EXPECT_EQ(frame.thermal_scale, (RadiometricScale{0.02, 5.0}));
  ASSERT_TRUE(frame.camera_nuc);
  EXPECT_EQ(frame.camera_nuc->state, NucState::kSettling);
  EXPECT_EQ(frame.camera_nuc->source, NucSource::kPolled);
  EXPECT_EQ(frame.camera_nuc->seconds_since, 1.5);
  EXPECT_EQ(frame.housekeeping.fpa_celsius, 30.5F);
  EXPECT_EQ(frame.housekeeping.housing_celsius, 31.5F);
  EXPECT_EQ(frame.housekeeping.shutter_celsius, 32.5F);
}

TEST_F(CameraProcessTest, TheCameraTellsWhatItIs) {
  Make("go-on");
  ASSERT_TRUE(camera_->Open().ok());
  ASSERT_TRUE(camera_->rig() && camera_->rig()->depth);
  EXPECT_EQ(camera_->rig()->depth->fx, 6.5);
  EXPECT_EQ(camera_->rig()->method, "nominal");
  ASSERT_EQ(camera_->cameras().size(), 1U);
  const CameraDescription camera = camera_->cameras()[0];
  EXPECT_EQ(camera.model, "Fake 1");
  EXPECT_EQ(camera.serial, "S-9");
  EXPECT_EQ(camera.rate_hz, 40.0);
  EXPECT_EQ(camera.settings, "all on");
  EXPECT_TRUE(camera.counts_only);
  EXPECT_EQ(camera.thermal_scale, (RadiometricScale{0.02, 5.0}));
}

TEST_F(CameraProcessTest, OrdersReachTheCameraAndItsAnswersComeBack) {
  Make("go-on");
  ASSERT_TRUE(camera_->Open().ok());
  EXPECT_FALSE(NextFrame().shutter_closed);
  ASSERT_EQ(camera_->Control(TriggerNuc{}), std::nullopt) << "the other process must be asked";
  while (!NextFrame().shutter_closed) ASSERT_FALSE(HasFailure());
  ASSERT_EQ(camera_->Control(SetAutomaticNuc{true}), std::nullopt);
  while (NextFrame().camera_nuc->state != NucState::kDesired) ASSERT_FALSE(HasFailure());
  const std::vector<ControlAnswer> answers = camera_->TakeControlAnswers();
  ASSERT_EQ(answers.size(), 2U);
  EXPECT_TRUE(answers[0].status.ok());
  EXPECT_TRUE(std::holds_alternative<TriggerNuc>(answers[0].control));
  EXPECT_TRUE(answers[1].status.ok());
  EXPECT_TRUE(std::holds_alternative<SetAutomaticNuc>(answers[1].control));
}

TEST_F(CameraProcessTest, ARefusalKeepsItsCodeAndWords) {
  Make("refuse");
  ASSERT_TRUE(camera_->Open().ok());
  ASSERT_EQ(camera_->Control(TriggerNuc{}), std::nullopt);
  std::vector<ControlAnswer> answers;
  while (answers.empty() && !HasFailure()) {
    NextFrame();
    answers = camera_->TakeControlAnswers();
  }
  ASSERT_EQ(answers.size(), 1U);
  EXPECT_EQ(answers[0].status.code(), StatusCode::kFailedPrecondition);
  EXPECT_EQ(answers[0].status.message(), "its shutter is glued");
}

TEST_F(CameraProcessTest, F14AnOrderAtWhichTheLibraryHangsIsAnsweredByTheEndOfItsProcess) {
  Make("hang-at-order");
  ASSERT_TRUE(camera_->Open().ok());
  NextFrame();
  ASSERT_EQ(camera_->Control(TriggerNuc{}), std::nullopt);
  EXPECT_THAT(Failure().message(), HasSubstr("hung for 0.5 s"));
  EXPECT_TRUE(camera_->TakeControlAnswers().empty());
  camera_->Close();
  const std::vector<ControlAnswer> answers = camera_->TakeControlAnswers();
  ASSERT_EQ(answers.size(), 1U);
  EXPECT_EQ(answers[0].status.code(), StatusCode::kUnavailable);
}

TEST_F(CameraProcessTest, AStopEndsAnOpeningAtOnce) {
  std::stop_source stop;
  CameraProcess::Settings settings = Fake("hang-at-open", 0);
  settings.open_timeout = 10 * kPatience;
  settings.stop = stop.get_token();
  camera_ = std::make_unique<CameraProcess>(settings, clock_);
  SteadyTime told{};
  // Right whenever it comes; after a moment the process runs and hangs.
  std::jthread later([&] {
    std::this_thread::sleep_for(milliseconds(100));
    told = clock_.SteadyNow();
    stop.request_stop();
  });
  EXPECT_EQ(camera_->Open().code(), StatusCode::kUnavailable);
  later.join();
  EXPECT_LT(clock_.SteadyNow() - told, kPromptly);
}

TEST_F(CameraProcessTest, F14ACrashIsAFailureAndItCanBeStartedAnew) {
  Make("crash", 3);
  ASSERT_TRUE(camera_->Open().ok());
  EXPECT_EQ(NextFrame().frame_number, 0U);
  const Status failure = Failure();
  EXPECT_EQ(failure.code(), StatusCode::kUnavailable);
  EXPECT_THAT(failure.message(), HasSubstr("signal 6"));
  camera_->Close();
  ASSERT_TRUE(camera_->Open().ok());
  EXPECT_EQ(NextFrame().frame_number, 3U) << "numbers go on";
}

TEST_F(CameraProcessTest, F14AHangIsEndedInTime) {
  Make("hang", 2);
  ASSERT_TRUE(camera_->Open().ok());
  NextFrame();
  const pid_t pid = camera_->pid();
  const SteadyTime last_frame = (NextFrame(), clock_.SteadyNow());
  const Status failure = Failure();
  EXPECT_THAT(failure.message(), HasSubstr("hung for 0.5 s"));
  EXPECT_GE(clock_.SteadyNow() - last_frame, milliseconds(400));
  EXPECT_EQ(::kill(pid, 0), -1) << "the process is gone";
}

TEST_F(CameraProcessTest, F14AHangWhileOpeningIsEndedToo) {
  CameraProcess::Settings settings = Fake("hang-at-open", 0);
  settings.open_timeout = milliseconds(300);
  camera_ = std::make_unique<CameraProcess>(settings, clock_);
  const Status opened = camera_->Open();
  EXPECT_EQ(opened.code(), StatusCode::kUnavailable);
  EXPECT_THAT(opened.message(), HasSubstr("did not open it within 0.3 s"));
  EXPECT_EQ(camera_->pid(), -1);
}

TEST_F(CameraProcessTest, FailuresKeepTheirCodeAndWords) {
  Make("cannot-open");
  EXPECT_EQ(camera_->Open().code(), StatusCode::kInvalidArgument);
  Make("fail", 1);
  ASSERT_TRUE(camera_->Open().ok());
  const Status failure = Failure();
  EXPECT_EQ(failure.code(), StatusCode::kDataLoss);
  EXPECT_EQ(failure.message(), "the camera sends nonsense");
}

TEST_F(CameraProcessTest, TheEndIsTheEnd) {
  Make("end", 1);
  ASSERT_TRUE(camera_->Open().ok());
  NextFrame();
  const Result<SourceItem> end = Next();
  ASSERT_TRUE(end.has_value());
  EXPECT_TRUE(std::holds_alternative<EndOfStream>(*end));
}

TEST_F(CameraProcessTest, AProgramThatIsNotThereIsSaidSo) {
  CameraProcess::Settings settings = Fake("go-on", 0);
  settings.program = "/nowhere/camera";
  camera_ = std::make_unique<CameraProcess>(settings, clock_);
  EXPECT_THAT(camera_->Open().message(), HasSubstr("/nowhere/camera"));
}

TEST_F(CameraProcessTest, ClosingEndsTheProcess) {
  Make("go-on");
  ASSERT_TRUE(camera_->Open().ok());
  NextFrame();
  const pid_t pid = camera_->pid();
  camera_->Close();
  EXPECT_EQ(::kill(pid, 0), -1);
}

TEST_F(CameraProcessTest, F14AProcessThatCannotBeEndedIsLeftBehindUntilItIsGone) {
  Make("hang", 2);
  ASSERT_TRUE(camera_->Open().ok());
  NextFrame();
  NextFrame();
  const pid_t pid = camera_->pid();
  ProcessHolder holder(pid);
  if (!holder.holds()) GTEST_SKIP() << "processes may not be traced here";
  EXPECT_THAT(Failure().message(), HasSubstr("hung for 0.5 s"));
  const SteadyTime told = clock_.SteadyNow();
  camera_->Close();
  EXPECT_LT(clock_.SteadyNow() - told, kPromptly);
  EXPECT_EQ(::kill(pid, 0), 0) << "it is still there";
  const Status refused = camera_->Open();
  EXPECT_EQ(refused.code(), StatusCode::kUnavailable);
  EXPECT_THAT(refused.message(), HasSubstr("has not ended"));
  EXPECT_EQ(camera_->pid(), -1) << "one that is stuck is enough";
  holder.Release();
  const SteadyTime end = clock_.SteadyNow() + kPatience;
  Status opened = camera_->Open();
  while (!opened.ok() && clock_.SteadyNow() < end) opened = camera_->Open();
  ASSERT_TRUE(opened.ok()) << opened.message();
  EXPECT_EQ(::kill(pid, 0), -1) << "taken when it was gone";
  EXPECT_EQ(NextFrame().frame_number, 2U);
}

TEST_F(CameraProcessTest, WhatNoSoundProcessSendsIsRefused) {
  const std::pair<const char*, const char*> cases[] = {
      {"bad-sensor", "sensor 2"},
      {"bad-nuc-state", "NUC state 99"},
      {"bad-scale", "thermal_scale"},
      {"bad-nuc-source", "from source 99"},
      {"bad-status", "status 99"},
      {"ok-as-failure", "without a reason"},
      {"bad-number", "sent frame 1152921504606846976"}};
  for (const auto& [what, message] : cases) {
    Make(what, 1);
    ASSERT_TRUE(camera_->Open().ok());
    EXPECT_EQ(NextFrame().frame_number, 0U) << what;
    const Status failure = Failure();
    EXPECT_EQ(failure.code(), StatusCode::kDataLoss) << what;
    EXPECT_THAT(failure.message(), HasSubstr(message));
  }
  Make("bad-camera");
  const Status opened = camera_->Open();
  EXPECT_EQ(opened.code(), StatusCode::kDataLoss);
  EXPECT_THAT(opened.message(), HasSubstr("a camera of sensor 7"));
}

TEST_F(CameraProcessTest, TheProcessCannotTakeTheSharedMemoryAway) {
  Make("shrink", 2);
  ASSERT_TRUE(camera_->Open().ok());
  for (std::uint64_t i = 0; i < 5; ++i) {
    const RawFrame frame = NextFrame();
    EXPECT_EQ(frame.frame_number, i);
    EXPECT_EQ(frame.pixels.At(0, 0), i);
  }
}

TEST_F(CameraProcessTest, FramesThatNobodyReadsAreLeftOutAndTheirNumbersMissing) {
  Make("go-on");
  ASSERT_TRUE(camera_->Open().ok());
  // A frame every 2 ms, while there are slots for eight.
  const SteadyTime until = clock_.SteadyNow() + milliseconds(400);
  while (clock_.SteadyNow() < until) std::this_thread::yield();
  for (std::uint64_t i = 0; i < PixelSlots::kSlots; ++i) {
    const RawFrame frame = NextFrame();
    EXPECT_EQ(frame.frame_number, i);
    EXPECT_EQ(frame.pixels.data()[0], i) << "a slot was overwritten";
  }
  const std::uint64_t next = NextFrame().frame_number;
  EXPECT_GT(next, static_cast<std::uint64_t>(PixelSlots::kSlots));
  // Every number is either a frame or counted; more may have been left out since.
  const auto left_out = camera_->TakeLeftOut();
  EXPECT_GE(left_out[static_cast<std::size_t>(Sensor::kThermal)], next - PixelSlots::kSlots);
  EXPECT_EQ(left_out[static_cast<std::size_t>(Sensor::kDepth)], 0U);
}

TEST_F(CameraProcessTest, ASourceThatWaitsLosesNothingHoweverLateItIsRead) {
  Make("patient");
  ASSERT_TRUE(camera_->Open().ok());
  const SteadyTime until = clock_.SteadyNow() + milliseconds(200);
  while (clock_.SteadyNow() < until) std::this_thread::yield();
  for (std::uint64_t i = 0; i < 3 * PixelSlots::kSlots; ++i) {
    EXPECT_EQ(NextFrame().frame_number, i);
  }
  EXPECT_EQ(camera_->TakeLeftOut()[static_cast<std::size_t>(Sensor::kThermal)], 0U);
}

TEST_F(CameraProcessTest, F14FramesThatWereLeftOutAreCountedAlsoWhenTheProcessDies) {
  constexpr int kFrames = 60;
  Make("crash", kFrames);
  ASSERT_TRUE(camera_->Open().ok());
  // Nobody reads until it has crashed: exactly the slots' frames get through.
  siginfo_t ended{};
  ASSERT_EQ(::waitid(P_PID, static_cast<id_t>(camera_->pid()), &ended, WEXITED | WNOWAIT), 0);
  for (std::uint64_t i = 0; i < PixelSlots::kSlots; ++i) EXPECT_EQ(NextFrame().frame_number, i);
  EXPECT_THAT(Failure().message(), HasSubstr("signal 6"));
  camera_->Close();
  constexpr auto kThermal = static_cast<std::size_t>(Sensor::kThermal);
  EXPECT_EQ(camera_->TakeLeftOut()[kThermal], kFrames - PixelSlots::kSlots);
  EXPECT_EQ(camera_->TakeLeftOut()[kThermal], 0U) << "taken once";
}

}  // namespace
}  // namespace isotherm
