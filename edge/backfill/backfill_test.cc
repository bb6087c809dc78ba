#include "edge/backfill/backfill.h"

#include <gtest/gtest.h>

#include <array>
#include <filesystem>
#include <memory>
#include <optional>
#include <random>
#include <string>
#include <thread>
#include <vector>

#include "common/recording/recording.h"
#include "common/testing/temporary_directory.h"
#include "common/testing/test_seed.h"
#include "edge/backfill/testing/simulated_link.h"

namespace isotherm {
namespace {

using namespace std::chrono_literals;

constexpr CaptureTime kStart{1'700'000'000s};
constexpr std::uint64_t kSession = SimulatedLink::kSession;
constexpr std::array<Sensor, 2> kSensors = {Sensor::kDepth, Sensor::kThermal};
constexpr Nanoseconds kPeriod = 25ms;  // Of both streams.

/// A recording of both streams, and what sends of it what the ground lacks.
class BackfillTest : public ::testing::Test {
 protected:
  BackfillTest() { Begin(1); }

  void Begin(std::uint64_t seed) {
    clock_.emplace(kStart);
    link_.emplace(*clock_, seed);
    recorded_.emplace();
    file_ = folder_.path() / (std::to_string(files_++) + ".mcap");
    writer_ = RecordingWriter::Create(file_, {.sync = false}).value();
    recorded_->BeginFile(file_);
    next_ = {};
    live_is_behind_ = false;
    backfill_.emplace(
        BackfillOptions{.frames_per_s = 400.0, .patience = patience_, .waits_for_ground = waits_},
        BackfillParts{*link_, *recorded_, counters_, *clock_, [this] { return live_is_behind_; }});
  }
  template <typename Frame>
  void Write(Sensor sensor, Frame frame) {
    const std::uint64_t number = next_.at(SensorIndex(sensor));
    frame.header = {.session = kSession,
                    .frame_number = number,
                    .capture_time = kStart + kPeriod * static_cast<std::int64_t>(number)};
    frame.image = {.encoding = Encoding::kRaw16, .width = 2, .height = 1, .payload = {1, 2, 3, 4}};
    ASSERT_TRUE(writer_->Write(frame, std::nullopt).ok());
    recorded_->Add(sensor, number, frame.header.capture_time);
  }
  /// Captures a frame of each stream: recorded, and sent if the link has room.
  void Capture() {
    EncodedDepthFrame depth;
    depth.depth_scale = 1000.0;
    Write(Sensor::kDepth, depth);
    Write(Sensor::kThermal, EncodedThermalFrame());
    for (const Sensor sensor : kSensors) {
      const std::uint64_t number = next_.at(SensorIndex(sensor))++;
      if (sends_live_) link_->SendLive(sensor, number);
    }
    Pass(kPeriod);
  }
  void Pass(Nanoseconds time) {
    constexpr Nanoseconds kStep = 5ms;
    for (Nanoseconds passed{0}; passed < time; passed += kStep) {
      while (backfill_->Step()) {
      }
      link_->Deliver();
      clock_->Advance(kStep);
    }
  }
  void CaptureFor(Nanoseconds time) {
    for (Nanoseconds passed{0}; passed < time; passed += kPeriod) Capture();
  }
  void End() {
    ASSERT_TRUE(writer_->Flush().ok());
    backfill_->NoteEnd();
  }
  std::uint64_t Missing() const {
    return link_->Missing(Sensor::kDepth, next_[0]) + link_->Missing(Sensor::kThermal, next_[1]);
  }

  const testing::TemporaryDirectory folder_;
  Nanoseconds patience_ = 5s;
  bool waits_ = true;
  int files_ = 0;
  std::optional<FakeClock> clock_;
  std::optional<SimulatedLink> link_;
  std::optional<RecordedFrames> recorded_;
  std::filesystem::path file_;
  std::unique_ptr<RecordingWriter> writer_;
  std::array<std::uint64_t, 2> next_{};
  FrameCounters counters_;
  bool live_is_behind_ = false;
  bool sends_live_ = true;
  std::optional<Backfill> backfill_;
};

TEST_F(BackfillTest, F28EverySecondFrameLeftForMinutesComesAllTheSame) {
  link_->leaves_frames = true;
  for (int i = 0; i < 9000; ++i) {
    sends_live_ = i % 2 == 0;  // Each that is left is a hole of its own.
    Capture();
  }
  EXPECT_EQ(link_->backfilled, 0U) << "there is no room";
  EXPECT_GT(backfill_->lacking(), 8900U) << "the ground tells the newest holes only";
  link_->leaves_frames = false;
  End();
  const SteadyTime end = clock_->SteadyNow();
  for (int i = 0; i < 600 && !backfill_->is_settled(); ++i) Pass(1s);
  EXPECT_TRUE(backfill_->is_settled());
  EXPECT_EQ(Missing(), 0U);
  EXPECT_LE(clock_->SteadyNow() - end, 60s) << "from the newest to the oldest, and not one by one";
}

TEST_F(BackfillTest, NumbersThatNobodyHasAreNotLackingHoweverManyHolesTheyAre) {
  for (int i = 0; i < 300; ++i) {
    Capture();
    for (std::uint64_t& next : next_) ++next;
  }
  Pass(1s);
  EXPECT_EQ(backfill_->lacking(), 0U);
  End();
  Pass(100ms);
  EXPECT_TRUE(backfill_->is_settled()) << "nothing is waited for";
  EXPECT_EQ(link_->backfilled, 0U);
}

TEST_F(BackfillTest, SendsWhatAnOutageHasCostWhileTheScanGoesOn) {
  CaptureFor(1s);
  link_->carries = false;
  CaptureFor(10s);
  EXPECT_EQ(link_->backfilled, 0U) << "nobody hears it";
  EXPECT_GT(backfill_->lacking(), 700U);
  link_->carries = true;
  CaptureFor(4s);
  EXPECT_LT(Missing(), 10U) << "at more than twice the rate of the cameras";
  End();
  Pass(1s);
  EXPECT_EQ(Missing(), 0U);
  EXPECT_EQ(link_->duplicates, 0U);
  EXPECT_EQ(backfill_->arrived(), link_->backfilled);
  EXPECT_EQ(backfill_->lacking(), 0U);
  EXPECT_TRUE(backfill_->is_settled());
}

TEST_F(BackfillTest, AGroundThatComesLateGetsTheWholeScan) {
  link_->ground_is_there = false;
  CaptureFor(5s);
  link_->ground_is_there = true;
  CaptureFor(3s);
  End();
  Pass(3s);
  EXPECT_EQ(Missing(), 0U);
}

TEST_F(BackfillTest, WhatIsLiveComesFirst) {
  CaptureFor(1s);
  link_->carries = false;
  CaptureFor(2s);
  link_->carries = true;
  live_is_behind_ = true;
  CaptureFor(2s);
  EXPECT_EQ(link_->backfilled, 0U);
  live_is_behind_ = false;
  CaptureFor(2s);
  End();
  Pass(2s);
  EXPECT_EQ(Missing(), 0U);
}

TEST_F(BackfillTest, ACameraThatWasLostWithFramesUnderWayHoldsNothingUp) {
  CaptureFor(1s);
  link_->carries = false;
  CaptureFor(2s);
  link_->carries = true;
  // Of the thermal camera nothing more comes: the ground does not hear of what it sent last.
  for (int i = 0; i < 160; ++i) {
    EncodedDepthFrame depth;
    depth.depth_scale = 1000.0;
    Write(Sensor::kDepth, depth);
    link_->SendLive(Sensor::kDepth, next_[0]++);
    Pass(kPeriod);
  }
  EXPECT_EQ(link_->Missing(Sensor::kDepth, next_[0]), 0U);
  End();
  Pass(3s);
  EXPECT_EQ(Missing(), 0U);
}

TEST_F(BackfillTest, AFileThatIsGoneIsGivenUpInTheEnd) {
  CaptureFor(1s);
  link_->carries = false;
  CaptureFor(1s);
  std::filesystem::remove(file_);
  link_->carries = true;
  CaptureFor(15s);
  End();
  Pass(6s);
  EXPECT_EQ(link_->backfilled, 0U);
  EXPECT_TRUE(backfill_->is_settled());
}

TEST_F(BackfillTest, WithoutAGroundNobodyIsWaitedForAtTheEnd) {
  link_->ground_is_there = false;
  CaptureFor(1s);
  EXPECT_FALSE(backfill_->is_settled()) << "the source has not ended";
  End();
  Pass(100ms);
  EXPECT_TRUE(backfill_->is_settled());
}

TEST_F(BackfillTest, AGroundThatWasCutOffIsWaitedForAtTheEnd) {
  CaptureFor(1s);
  link_->carries = false;
  CaptureFor(1s);
  End();
  Pass(60s);
  EXPECT_FALSE(backfill_->is_settled());
  link_->carries = true;
  Pass(5s);
  EXPECT_EQ(Missing(), 0U) << "what was sent last as well, of which the ground does not know";
  EXPECT_TRUE(backfill_->is_settled());
  EXPECT_EQ(backfill_->arrived(), link_->duplicates + 80) << "each that arrived counts";
  EXPECT_LE(link_->backfilled, 200U) << "what was sent into the outage, and not again and again";
}

TEST_F(BackfillTest, AGroundThatTakesNothingIsWaitedForNoLongerThanAsked) {
  waits_ = false;
  Begin(1);
  CaptureFor(1s);
  link_->carries = false;
  CaptureFor(1s);
  End();
  Pass(4900ms);
  EXPECT_FALSE(backfill_->is_settled());
  Pass(200ms);
  EXPECT_TRUE(backfill_->is_settled());
}

TEST_F(BackfillTest, FramesThatTheRecordingDoesNotHaveAfterAllStopNoOthers) {
  CaptureFor(1s);
  link_->carries = false;
  CaptureFor(1s);
  // The disk has taken these and lost them.
  for (int i = 0; i < 40; ++i) {
    for (const Sensor sensor : kSensors) {
      const std::uint64_t number = next_.at(SensorIndex(sensor))++;
      recorded_->Add(sensor, number, kStart + kPeriod * static_cast<std::int64_t>(number));
    }
    Pass(kPeriod);
  }
  CaptureFor(1s);
  link_->carries = true;
  CaptureFor(3s);
  End();
  Pass(5s);
  EXPECT_EQ(Missing(), 80U);
  EXPECT_EQ(backfill_->lacking(), 0U) << "the recording has nothing of what is missing";
  EXPECT_TRUE(backfill_->is_settled());
}

TEST_F(BackfillTest, AFrameThatTheGroundRefusesIsNotSentForEver) {
  link_->refused = 20;
  CaptureFor(50s);
  EXPECT_EQ(Missing(), 2U);
  const std::uint64_t sent = link_->backfilled;
  EXPECT_LE(sent, 50U);
  CaptureFor(50s);
  EXPECT_EQ(link_->backfilled, sent);
}

TEST_F(BackfillTest, OtherThreadsMayAskWhileItRuns) {
  SystemClock clock;
  FrameCounters counters;
  Backfill backfill({.frames_per_s = 100.0, .patience = 0s},
                    {*link_, *recorded_, counters, clock, [] { return false; }});
  std::jthread thread([&](const std::stop_token& stop) { backfill.Run(stop); });
  EXPECT_EQ(backfill.lacking(), 0U);
  backfill.NoteEnd();
  thread.join();
  EXPECT_TRUE(backfill.is_settled());
}

/// A seeded history: outages, losses, delays, restarts of the ground, live frames that wait.
TEST_F(BackfillTest, WhateverHappensToTheLinkAllArrivesInTheEnd) {
  patience_ = 60s;  // Of the last frame ten copies in a row may get lost.
  constexpr unsigned kHistories = 150;
  const std::uint32_t seed = testing::Seed();
  for (unsigned history = 0; history < kHistories; ++history) {
    std::mt19937 random(seed + history);
    Begin(random());
    const auto chance = [&random](unsigned one_in) { return random() % one_in == 0; };
    int restarts = 0;
    for (int part = 0; part < 8; ++part) {
      link_->carries = !chance(3);
      link_->loss = chance(2) ? 0.0 : 0.001 * static_cast<double>(random() % 300);
      link_->delay = 1ms * (1 + random() % 300);
      live_is_behind_ = chance(5);
      link_->ground_is_there = !chance(6);
      if (chance(6)) {
        link_->RestartGround();
        ++restarts;
      }
      CaptureFor(100ms * (1 + random() % 20));
      if (chance(2)) {
        ASSERT_TRUE(writer_->Flush().ok());
      }
    }
    link_->carries = link_->ground_is_there = true;
    link_->loss = chance(2) ? 0.0 : 0.1;
    live_is_behind_ = false;
    CaptureFor(100ms);
    End();
    for (int s = 0; s < 120 && !backfill_->is_settled(); ++s) Pass(1s);
    ASSERT_EQ(Missing(), 0U) << "history " << history;
    ASSERT_TRUE(backfill_->is_settled());
    ASSERT_EQ(backfill_->lacking(), 0U);
    // A receipt may be older than what is under way: some frames come twice, never many.
    const std::uint64_t frames = next_[0] + next_[1];
    ASSERT_LE(link_->backfilled, (2 + static_cast<std::uint64_t>(restarts)) * frames);
    std::filesystem::remove(file_);
  }
}

TEST_F(BackfillTest, F41FramesThatAreDeletedBeforeTheGroundHasThemAreCounted) {
  link_->carries = false;
  CaptureFor(10s);
  const auto next_file = [this] {
    const std::filesystem::path before = file_;
    ASSERT_TRUE(writer_->Close().ok());
    file_ = folder_.path() / (std::to_string(files_++) + ".mcap");
    writer_ = RecordingWriter::Create(file_, {.sync = false}).value();
    recorded_->BeginFile(file_);
    recorded_->DeleteUpTo(before);
  };
  next_file();
  CaptureFor(1s);
  EXPECT_EQ(backfill_->gone(), 800U) << "no ground has ever been there";
  link_->carries = true;
  CaptureFor(5s);
  EXPECT_EQ(backfill_->gone(), 800U);
  next_file();
  CaptureFor(5s);
  EXPECT_EQ(backfill_->gone(), 800U) << "what was deleted now had arrived";
  End();
  Pass(10s);
  EXPECT_TRUE(backfill_->is_settled());
  EXPECT_EQ(Missing(), 800U);
}

}  // namespace
}  // namespace isotherm
