// OpenniDepthSource on the genuine OpenNI2 library, with a driver whose camera does what a script
// says.

#include "edge/openni/openni_depth_source.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "common/testing/temporary_directory.h"
#include "edge/openni/openni_list.h"
#include "edge/openni/testing/fake_depth_camera.h"
#include "edge/options/edge_options.pb.h"

namespace isotherm {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;
using ::testing::HasSubstr;

/// Far more than a frame takes to come; a limit for hanging.
constexpr seconds kPatience{20};
/// The angles travel as 32-bit floats; at 600 px that is far below this.
constexpr double kFocalTolerance_px = 0.01;

class OpenniDepthSourceTest : public ::testing::Test {
 protected:
  OpenniDepthSourceTest() {
    // Quick and small; tests that are about the size choose another.
    options_.mutable_expert()->set_width(320);
    options_.mutable_expert()->set_height(240);
    options_.mutable_expert()->set_rate_hz(60);
  }

  Status Open() {
    camera_.Apply();
    source_ = std::make_unique<OpenniDepthSource>(options_, 1.0, clock_);
    return source_->Open();
  }
  /// The next frame, or the failure.
  Result<RawFrame> Next() {
    const SteadyTime end = clock_.SteadyNow() + kPatience;
    while (clock_.SteadyNow() < end) {
      Result<SourceItem> item = source_->Read({});
      if (!item) return Err(item.error());
      if (auto* frame = std::get_if<RawFrame>(&*item)) return std::move(*frame);
    }
    return Err(Internal("no frame and no failure"));
  }
  std::vector<RawFrame> Read(int count) {
    std::vector<RawFrame> frames;
    for (int i = 0; i < count; ++i) {
      Result<RawFrame> frame = Next();
      if (!frame) {
        ADD_FAILURE() << frame.error().message();
        break;
      }
      frames.push_back(std::move(*frame));
    }
    return frames;
  }
  /// Reads until it fails.
  Status ReadToFailure() {
    while (true) {
      const Result<RawFrame> frame = Next();
      if (!frame) return frame.error();
    }
  }

  const testing::TemporaryDirectory folder_;
  FakeDepthCamera camera_;
  DepthCameraOptions options_;
  const SystemClock clock_{};
  std::unique_ptr<OpenniDepthSource> source_;
};

TEST_F(OpenniDepthSourceTest, DeliversWhatTheCameraSeesUnmirrored) {
  options_.mutable_expert()->set_width(640);
  options_.mutable_expert()->set_height(480);
  options_.mutable_expert()->set_rate_hz(30);
  const CaptureTime before = clock_.Now();
  ASSERT_TRUE(Open().ok());
  const std::vector<RawFrame> frames = Read(2);
  ASSERT_EQ(frames.size(), 2U);
  const RawFrame& frame = frames[0];
  EXPECT_EQ(frame.sensor, Sensor::kDepth);
  EXPECT_TRUE(frame.has_device_clock);
  EXPECT_GE(frame.arrival_wall, before);
  EXPECT_LE(frame.arrival_wall, clock_.Now());
  EXPECT_LE(frame.arrival_steady, clock_.SteadyNow());
  EXPECT_NE(frame.arrival_steady, SteadyTime{});
  EXPECT_EQ(frame.depth_scale, 1000.0);
  ASSERT_EQ(frame.pixels.width(), 640);
  ASSERT_EQ(frame.pixels.height(), 480);
  for (int v = 0; v < 480; v += 7) {
    for (int u = 0; u < 640; ++u) ASSERT_EQ(frame.pixels.At(u, v), FakePlaneMillimetres(u, v));
  }
}

TEST_F(OpenniDepthSourceTest, UndoesMirroringThatTheCameraDoesNotSwitchOff) {
  camera_.script.mirroring_stays_on = true;
  ASSERT_TRUE(Open().ok());
  const std::vector<RawFrame> frames = Read(1);
  ASSERT_EQ(frames.size(), 1U);
  for (int u = 0; u < 320; ++u)
    ASSERT_EQ(frames[0].pixels.At(u, 100), FakePlaneMillimetres(u, 100));
  EXPECT_THAT(source_->cameras().at(0).settings, HasSubstr("mirroring on (undone here)"));
}

TEST_F(OpenniDepthSourceTest, ReportsWhatItReadBack) {
  options_.mutable_expert()->set_close_range(true);
  options_.mutable_expert()->set_registration(true);
  ASSERT_TRUE(Open().ok());
  ASSERT_EQ(source_->cameras().size(), 1U);
  const CameraDescription camera = source_->cameras()[0];
  EXPECT_EQ(camera.sensor, Sensor::kDepth);
  EXPECT_EQ(camera.driver, "openni2");
  EXPECT_EQ(camera.serial, "FAKE-1");
  EXPECT_EQ(camera.width, 320);
  EXPECT_EQ(camera.height, 240);
  EXPECT_EQ(camera.rate_hz, 60.0);
  EXPECT_EQ(camera.settings, "unit 1 mm, mirroring off, registration on, close range on");
}

TEST_F(OpenniDepthSourceTest, TenthMillimetresAreScaledAsSuch) {
  options_.mutable_expert()->set_rate_hz(30);
  options_.mutable_expert()->set_unit(TENTH_MILLIMETRE);
  ASSERT_TRUE(Open().ok());
  const std::vector<RawFrame> frames = Read(1);
  ASSERT_EQ(frames.size(), 1U);
  EXPECT_EQ(frames[0].depth_scale, 10'000.0);
  EXPECT_EQ(frames[0].pixels.At(100, 100), 10 * FakePlaneMillimetres(100, 100));
  EXPECT_EQ(source_->rig()->depth_scale, 10'000.0);
}

TEST_F(OpenniDepthSourceTest, IntrinsicsComeFromTheFieldOfView) {
  options_.mutable_expert()->set_width(640);
  options_.mutable_expert()->set_height(480);
  options_.mutable_expert()->set_rate_hz(30);
  camera_.script.horizontal_fov_rad = 1.0;
  camera_.script.vertical_fov_rad = 0.75;
  ASSERT_TRUE(Open().ok());
  const std::optional<Rig> rig = source_->rig();
  ASSERT_TRUE(rig && rig->depth);
  EXPECT_NEAR(rig->depth->fx, 585.75607, kFocalTolerance_px);  // 320 / tan(0.5)
  EXPECT_NEAR(rig->depth->fy, 609.71474, kFocalTolerance_px);  // 240 / tan(0.375)
  EXPECT_EQ(rig->depth->cx, 319.5);
  EXPECT_EQ(rig->depth->cy, 239.5);
  EXPECT_FALSE(rig->thermal);
  EXPECT_FALSE(rig->T_thermal_depth);
  EXPECT_THAT(rig->method, HasSubstr("nominal"));
  EXPECT_TRUE(Validate(*rig).ok());
}

TEST_F(OpenniDepthSourceTest, IntrinsicsComeFromTheZeroPlaneIfThereIsNoFieldOfView) {
  camera_.script.has_field_of_view = false;
  ASSERT_TRUE(Open().ok());
  ASSERT_TRUE(source_->rig());
  // 120 mm / 0.1042 mm at 1280 pixels, a quarter of that at 320.
  EXPECT_NEAR(source_->rig()->depth->fx, 287.908, kFocalTolerance_px);
  EXPECT_EQ(source_->rig()->depth->fy, source_->rig()->depth->fx);
}

TEST_F(OpenniDepthSourceTest, ThereIsNoRigIfTheCameraSaysNothing) {
  camera_.script.has_field_of_view = false;
  camera_.script.has_zero_plane = false;
  ASSERT_TRUE(Open().ok());
  EXPECT_FALSE(source_->rig());
}

TEST_F(OpenniDepthSourceTest, AModeThatIsNotThereIsRefusedWithThoseThatAre) {
  options_.mutable_expert()->set_rate_hz(50);
  const Status opened = Open();
  EXPECT_EQ(opened.code(), StatusCode::kInvalidArgument);
  EXPECT_THAT(opened.message(), HasSubstr("320x240@50 1 mm"));
  EXPECT_THAT(opened.message(), HasSubstr("640x480@30 0.1 mm"));
}

TEST_F(OpenniDepthSourceTest, SettingsThatTheCameraLacksAreRefused) {
  camera_.script.has_close_range = false;
  camera_.script.has_registration = false;
  ASSERT_TRUE(Open().ok());
  EXPECT_THAT(source_->cameras()[0].settings, HasSubstr("close range not there"));
  source_->Close();
  options_.mutable_expert()->set_close_range(true);
  EXPECT_EQ(Open().code(), StatusCode::kInvalidArgument);
  options_.mutable_expert()->clear_close_range();
  options_.mutable_expert()->set_registration(true);
  EXPECT_EQ(Open().code(), StatusCode::kInvalidArgument);
}

TEST_F(OpenniDepthSourceTest, NoCameraIsSaidSo) {
  camera_.script.connected = false;
  const Status opened = Open();
  EXPECT_EQ(opened.code(), StatusCode::kUnavailable);
  EXPECT_THAT(opened.message(), HasSubstr("no depth camera is connected"));
}

TEST_F(OpenniDepthSourceTest, F03AnotherSerialNumberIsRefused) {
  options_.set_serial("FAKE-1");
  ASSERT_TRUE(Open().ok());
  source_->Close();
  camera_.script.serial = "FAKE-2";
  const Status opened = Open();
  EXPECT_EQ(opened.code(), StatusCode::kUnavailable);
  EXPECT_THAT(opened.message(), HasSubstr("FAKE-2"));
}

TEST_F(OpenniDepthSourceTest, FramesLostInTheCameraLeaveHoles) {
  camera_.script.faults[4] = {FakeDepthFault::kDrop, 3, 0};
  ASSERT_TRUE(Open().ok());
  // The library may lose frames as well on a busy computer: only what must be is checked. Frame i
  // of the camera comes at 1 s + i / 60 s.
  const std::vector<RawFrame> frames = Read(8);
  ASSERT_EQ(frames.size(), 8U);
  const DeviceTicks first = frames[0].device_ticks;
  for (const RawFrame& frame : frames) {
    const double periods = ToSeconds(frame.device_ticks - first) * 60.0;
    EXPECT_EQ(frame.frame_number, static_cast<std::uint64_t>(std::lround(periods)));
  }
  EXPECT_GE(frames.back().frame_number, 10U) << "three were dropped";
}

TEST_F(OpenniDepthSourceTest, F09AFlippedBitOfAFramesNumberCostsNoNumbers) {
  constexpr int kFlipped = 12;
  camera_.script.faults[kFlipped] = {FakeDepthFault::kFlip, 1, 0};
  ASSERT_TRUE(Open().ok());
  // On a busy computer the library loses some: numbers must say so all the same, but for the frame
  // whose own number is wrong.
  std::optional<std::int64_t> first;
  std::uint64_t last = 0;
  for (std::int64_t index = 0; index < 2 * kFlipped;) {
    const std::vector<RawFrame> frames = Read(1);
    ASSERT_EQ(frames.size(), 1U);
    // Frame i of the camera comes at 1 s + i / 60 s.
    index = std::lround((ToSeconds(frames[0].device_ticks.time_since_epoch()) - 1.0) * 60.0);
    if (!first) first = index;
    EXPECT_GE(frames[0].frame_number, last);
    last = frames[0].frame_number + 1;
    if (index == kFlipped) continue;
    EXPECT_EQ(frames[0].frame_number, static_cast<std::uint64_t>(index - *first));
  }
}

TEST_F(OpenniDepthSourceTest, F09A32BitClockIsUnwrapped) {
  camera_.script.wraps_at_32_bits = true;
  camera_.script.first_timestamp_us = (1ULL << 32U) - 50'000;  // Wraps after three frames.
  ASSERT_TRUE(Open().ok());
  const std::vector<RawFrame> frames = Read(8);
  ASSERT_EQ(frames.size(), 8U);
  for (std::size_t i = 1; i < frames.size(); ++i) {
    EXPECT_GT(frames[i].device_ticks, frames[i - 1].device_ticks);
  }
  EXPECT_GT(frames.back().device_ticks.time_since_epoch().count(), 1LL << 32U);
}

TEST_F(OpenniDepthSourceTest, F09AClockSetBackGoesBackwards) {
  camera_.script.faults[4] = {FakeDepthFault::kJump, 1, -500'000};
  ASSERT_TRUE(Open().ok());
  int backwards = 0;
  const std::vector<RawFrame> frames = Read(8);
  for (std::size_t i = 1; i < frames.size(); ++i) {
    backwards += frames[i].device_ticks < frames[i - 1].device_ticks ? 1 : 0;
    EXPECT_GT(frames[i].frame_number, frames[i - 1].frame_number);
  }
  EXPECT_EQ(backwards, 1);
}

TEST_F(OpenniDepthSourceTest, F11ShortFramesHaveNoPixels) {
  camera_.script.faults[1] = {FakeDepthFault::kShort, 1000, 0};
  ASSERT_TRUE(Open().ok());
  const std::vector<RawFrame> frames = Read(2);
  ASSERT_EQ(frames.size(), 2U);
  EXPECT_TRUE(frames[0].pixels.empty());
}

TEST_F(OpenniDepthSourceTest, F11FramesOfAnotherSizeKeepIt) {
  camera_.script.faults[1] = {FakeDepthFault::kWrongSize, 1000, 0};
  ASSERT_TRUE(Open().ok());
  const std::vector<RawFrame> frames = Read(1);
  ASSERT_EQ(frames.size(), 1U);
  EXPECT_EQ(frames[0].pixels.height(), 120);
}

TEST_F(OpenniDepthSourceTest, F01UnpluggingIsAFailureAndF02ReopeningGoesOn) {
  ASSERT_TRUE(Open().ok());
  const std::uint64_t last = Read(3).back().frame_number;
  camera_.Plug(false);
  const Status lost = ReadToFailure();
  EXPECT_EQ(lost.code(), StatusCode::kUnavailable);
  EXPECT_THAT(lost.message(), HasSubstr("unplugged"));
  source_->Close();
  EXPECT_EQ(source_->Open().code(), StatusCode::kUnavailable);
  camera_.Plug(true);
  ASSERT_TRUE(source_->Open().ok());
  const std::vector<RawFrame> frames = Read(2);
  ASSERT_EQ(frames.size(), 2U);
  EXPECT_GT(frames[0].frame_number, last);
  EXPECT_EQ(frames[0].pixels.At(100, 100), FakePlaneMillimetres(100, 100));
}

TEST_F(OpenniDepthSourceTest, AStallIsAFailure) {
  camera_.script.faults[3] = {FakeDepthFault::kStall, 1, 0};
  options_.mutable_expert()->set_stall_timeout_s(0.3);
  ASSERT_TRUE(Open().ok());
  const Status stalled = ReadToFailure();
  EXPECT_EQ(stalled.code(), StatusCode::kUnavailable);
  EXPECT_THAT(stalled.message(), HasSubstr("no frame for 0."));
}

TEST_F(OpenniDepthSourceTest, ReadIsBoundedWhileNothingComes) {
  camera_.script.faults[1] = {FakeDepthFault::kStall, 1, 0};
  ASSERT_TRUE(Open().ok());
  const SteadyTime start = clock_.SteadyNow();
  ASSERT_TRUE(source_->Read({}).has_value());
  // It promises 0.1 s; the rest is for a computer that does something else.
  EXPECT_LT(clock_.SteadyNow() - start, seconds(1));
}

TEST_F(OpenniDepthSourceTest, TheListShowsSerialAndModes) {
  const auto list = ListOpenniCameras();
  ASSERT_TRUE(list.has_value());
  ASSERT_EQ(list->size(), 1U);
  EXPECT_EQ((*list)[0].product, "Isotherm Fake Depth Camera");
  EXPECT_EQ((*list)[0].serial, "FAKE-1");
  EXPECT_EQ((*list)[0].bus_port, "fake-depth://0");
  EXPECT_THAT((*list)[0].modes, ::testing::Contains("640x480@30 0.1 mm"));
  EXPECT_EQ((*list)[0].problem, "");
}

}  // namespace
}  // namespace isotherm
