// OpenniDepthSource plays what OpenNI2's own recorder wrote.

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "common/testing/temporary_directory.h"
#include "edge/openni/openni_depth_source.h"
#include "edge/openni/testing/fake_depth_camera.h"
#include "edge/openni/testing/record_oni.h"
#include "edge/options/edge_options.pb.h"

namespace isotherm {
namespace {

constexpr int kFrames = 12;
constexpr std::chrono::microseconds kPeriod{16'667};  // 60 Hz.
constexpr std::chrono::microseconds kRounding{1};

class OniFileTest : public ::testing::Test {
 protected:
  void SetUp() override {
    const Status recorded = RecordOni(file_, kFrames);
    ASSERT_TRUE(recorded.ok()) << recorded.message();
  }

  std::vector<RawFrame> Play(double rate) {
    DepthCameraOptions options;
    options.set_uri(file_.string());
    OpenniDepthSource source(options, rate, clock_);
    std::vector<RawFrame> frames;
    const Status opened = source.Open();
    EXPECT_TRUE(opened.ok()) << opened.message();
    if (!opened.ok()) return frames;
    description_ = source.cameras().at(0);
    while (true) {
      Result<SourceItem> item = source.Read({});
      EXPECT_TRUE(item.has_value());
      if (!item || std::holds_alternative<EndOfStream>(*item)) return frames;
      if (auto* frame = std::get_if<RawFrame>(&*item)) frames.push_back(std::move(*frame));
    }
  }

  const testing::TemporaryDirectory folder_;
  const FakeDepthCamera camera_{};
  const std::filesystem::path file_ = folder_.path() / "scan.oni";
  const SystemClock clock_{};
  CameraDescription description_;
};

TEST_F(OniFileTest, EveryFrameComesOnceAsItWasAndThenItEnds) {
  const std::vector<RawFrame> frames = Play(0.0);
  ASSERT_GE(frames.size(), static_cast<std::size_t>(kFrames));
  for (std::size_t i = 0; i < frames.size(); ++i) {
    EXPECT_EQ(frames[i].frame_number, i);
    ASSERT_EQ(frames[i].pixels.width(), 320);
    ASSERT_EQ(frames[i].pixels.height(), 240);
    for (int u = 0; u < 320; ++u)
      ASSERT_EQ(frames[i].pixels.At(u, 77), FakePlaneMillimetres(u, 77));
  }
  EXPECT_EQ(description_.driver, "oni-file");
  EXPECT_EQ(description_.width, 320);
}

TEST_F(OniFileTest, TimesAreThoseOfTheCamera) {
  const std::vector<RawFrame> frames = Play(0.0);
  ASSERT_GE(frames.size(), static_cast<std::size_t>(kFrames));
  for (std::size_t i = 1; i < frames.size(); ++i) {
    const auto ticks = frames[i].device_ticks - frames[i - 1].device_ticks;
    EXPECT_LE(std::chrono::abs(ticks - kPeriod), kRounding) << "frame " << i;
    EXPECT_EQ(frames[i].arrival_wall - frames[i - 1].arrival_wall, Nanoseconds(ticks))
        << "played without a pace, arrivals are where the camera's clock puts them";
  }
}

TEST_F(OniFileTest, PlaysInRealTimeToo) {
  const SteadyTime start = clock_.SteadyNow();
  const std::vector<RawFrame> frames = Play(1.0);
  // The library hands over the newest only, so a busy computer may miss some.
  EXPECT_GE(frames.size(), 3U);
  EXPECT_GE(clock_.SteadyNow() - start, (kFrames - 2) * kPeriod);
}

TEST_F(OniFileTest, ItIsLetGoOfAtAnyMomentAndPlayedAgain) {
  DepthCameraOptions options;
  options.set_uri(file_.string());
  for (const double rate : {0.0, 1.0}) {
    for (int wanted = 0; wanted < 5; ++wanted) {
      OpenniDepthSource source(options, rate, clock_);
      ASSERT_TRUE(source.Open().ok());
      for (int frames = 0; frames < wanted;) {
        const Result<SourceItem> item = source.Read({});
        // In real time a busy computer may miss frames, or find that none came for too long.
        if (!item || std::holds_alternative<EndOfStream>(*item)) break;
        if (std::holds_alternative<RawFrame>(*item)) ++frames;
      }
    }
  }
}

TEST_F(OniFileTest, WhatIsNoRecordingIsRefused) {
  DepthCameraOptions options;
  options.set_uri((folder_.path() / "missing.oni").string());
  EXPECT_EQ(OpenniDepthSource(options, 1.0, clock_).Open().code(), StatusCode::kNotFound);
  const std::filesystem::path text = folder_.path() / "text.oni";
  std::ofstream(text) << "not a recording\n";
  options.set_uri(text.string());
  EXPECT_EQ(OpenniDepthSource(options, 1.0, clock_).Open().code(), StatusCode::kDataLoss);
}

}  // namespace
}  // namespace isotherm
