// The driver of Seek cameras on an emulated one, through the genuine libusb.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <string>

#include "edge/thermal_camera/testing/camera_fixture.h"
#include "edge/thermal_camera/testing/emulated_seek.h"

namespace isotherm {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

class EmulatedSeekTest : public EmulatedCameraTest {
 protected:
  std::shared_ptr<EmulatedSeek> PlugSeek(std::string_view script, EmulatedSeek::Setup setup = {}) {
    auto camera = std::make_shared<EmulatedSeek>(script, setup);
    bus_->Plug(camera);
    return camera;
  }
};

/// Dead detectors show what is up to three columns beside them, of a ramp of one count per column.
constexpr int kFillError = 3;

/// The emulated ramp against its shutter, whose detectors all differ.
void ExpectCounts(const RawFrame& frame) {
  ASSERT_FALSE(frame.pixels.empty());
  for (int y = 0; y < frame.pixels.height(); ++y) {
    for (int x = 0; x < frame.pixels.width(); ++x) {
      const int error = EmulatedSeek::IsDead(x, y) ? kFillError : 0;
      const int count = frame.pixels.At(x, y);
      ASSERT_GE(count, kSeekMiddle + x - error) << x << " " << y;
      ASSERT_LE(count, kSeekMiddle + x + EmulatedSeek::kNoise - 1 + error) << x << " " << y;
    }
  }
}

TEST_F(EmulatedSeekTest, IsListedByItsProduct) {
  PlugSeek("f", {kSeekCompactPro, false, 0});
  const auto devices = ListThermalCameras();
  ASSERT_TRUE(devices.has_value()) << devices.error().message();
  ASSERT_EQ(devices->size(), 1U);
  EXPECT_EQ(devices->front().driver, "seek-bulk");
  EXPECT_EQ(devices->front().product, "Seek CompactPro");
  EXPECT_THAT(devices->front().modes, ElementsAre("320x240, 9 Hz, counts only"));
}

TEST_F(EmulatedSeekTest, BothModelsSendCountsWithoutTemperatures) {
  for (const SeekModel& model : {kSeekCompact, kSeekCompactPro}) {
    SCOPED_TRACE(model.name);
    const auto camera = PlugSeek("f", {model, false, 0});
    const auto source = Open();
    EXPECT_TRUE(source->cameras().front().counts_only);
    EXPECT_EQ(source->cameras().front().serial, EmulatedSeek::kChipIdText);
    const std::vector<RawFrame> frames = ReadFrames(*source, 6);
    ASSERT_EQ(frames.size(), 6U) << failure_.message();
    // First the shutter, against itself.
    EXPECT_TRUE(frames[0].shutter_closed);
    EXPECT_EQ(frames[0].camera_nuc->state, NucState::kInProgress);
    for (std::size_t i = 1; i < frames.size(); ++i) {
      EXPECT_EQ(frames[i].pixels.width(), model.width);
      EXPECT_EQ(frames[i].pixels.height(), model.height);
      ExpectCounts(frames[i]);
      EXPECT_EQ(frames[i].camera_nuc->state, NucState::kIdle);
      EXPECT_EQ(frames[i].camera_nuc->source, NucSource::kInBand);
      EXPECT_EQ(frames[i].frame_number, i);
      EXPECT_FALSE(frames[i].has_device_clock);
      EXPECT_GT(frames[i].arrival_steady, frames[i - 1].arrival_steady);
    }
    EXPECT_EQ(source->counts().lost, 0U);
    source->Close();
    EXPECT_FALSE(camera->running());
    bus_->Unplug();
  }
}

TEST_F(EmulatedSeekTest, OptionsMayRelateCountsToTemperatures) {
  options_.mutable_expert()->set_kelvin_per_count(0.02);
  options_.mutable_expert()->set_offset_kelvin(-30.0);
  PlugSeek("f");
  const auto source = Open();
  EXPECT_FALSE(source->cameras().front().counts_only);
  const std::vector<RawFrame> frames = ReadFrames(*source, 2);
  ASSERT_EQ(frames.size(), 2U) << failure_.message();
  // 0x4000 x 0.02 - 30 = 297.68 K, and up to 7 counts of noise.
  const double kelvin = frames[1].thermal_scale.Kelvin(frames[1].pixels.At(0, 50));
  EXPECT_GE(kelvin, 297.679);
  EXPECT_LE(kelvin, 297.681 + 7 * 0.02);
}

TEST_F(EmulatedSeekTest, StartsAsPublishedAndGoesToSleep) {
  const auto camera = PlugSeek("f");
  const auto source = Open();
  ASSERT_EQ(ReadFrames(*source, 1).size(), 1U) << failure_.message();
  source->Close();
  const std::vector<int>& opcodes = camera->opcodes();
  const std::vector<int> start = {84, 60, 78, 54, 86, 88, 86, 88, 86,
                                  88, 86, 88, 62, 61, 62, 60, 61};
  ASSERT_GE(opcodes.size(), start.size() + 3);
  EXPECT_TRUE(std::equal(start.begin(), start.end(), opcodes.begin()));
  EXPECT_THAT(std::vector<int>(opcodes.end() - 3, opcodes.end()), ElementsAre(60, 60, 60));
}

TEST_F(EmulatedSeekTest, CameraThatWasLeftRunningIsPutToSleepFirst) {
  const auto camera = PlugSeek("f", {kSeekCompact, true, 0});
  const auto source = Open();
  EXPECT_EQ(ReadFrames(*source, 2).size(), 2U) << failure_.message();
  EXPECT_EQ(camera->starts(), 1);
}

TEST_F(EmulatedSeekTest, FirstFrameWithoutBeginningStartsItAgain) {
  const auto camera = PlugSeek("f", {kSeekCompact, false, 1});
  const auto source = Open();
  const std::vector<RawFrame> frames = ReadFrames(*source, 3);
  ASSERT_EQ(frames.size(), 3U) << failure_.message();
  ExpectCounts(frames[2]);
  EXPECT_EQ(camera->starts(), 2);
}

TEST_F(EmulatedSeekTest, CameraThatNeverSendsItsFirstFrameIsGivenUp) {
  options_.mutable_expert()->set_stall_timeout_s(10.0);
  const auto camera = PlugSeek("f", {kSeekCompact, false, 99});
  EXPECT_TRUE(ReadFrames(*Open(), 1).empty());
  EXPECT_EQ(failure_.code(), StatusCode::kDataLoss);
  EXPECT_THAT(failure_.message(), HasSubstr("first frame is incomplete"));
  EXPECT_EQ(camera->starts(), 3);
}

TEST_F(EmulatedSeekTest, ShutterFramesAreCorrectionsOfTheCameraItself) {
  PlugSeek("3*f f:nuc 3*f");
  const auto source = Open();
  const std::vector<RawFrame> frames = ReadFrames(*source, 8);
  ASSERT_EQ(frames.size(), 8U) << failure_.message();
  for (std::size_t i = 0; i < frames.size(); ++i) {
    EXPECT_EQ(frames[i].shutter_closed, i == 0 || i == 4) << i;
    EXPECT_EQ(frames[i].frame_number, i);
  }
  const Status ordered = *source->Control(TriggerNuc{});
  EXPECT_EQ(ordered.code(), StatusCode::kFailedPrecondition);
  EXPECT_THAT(ordered.message(), HasSubstr("closes its shutter when it sees fit"));
  EXPECT_FALSE(source->Control(SetAutomaticNuc{false})->ok());
}

TEST_F(EmulatedSeekTest, FramesOfTheCamerasOwnBusinessAreNoLoss) {
  PlugSeek("2*f f:other 2*f f:skip f");
  const auto source = Open();
  const std::vector<RawFrame> frames = ReadFrames(*source, 7);
  ASSERT_EQ(frames.size(), 7U) << failure_.message();
  EXPECT_EQ(source->counts().lost, 3U);
  EXPECT_EQ(frames[4].frame_number, 4U);
  EXPECT_EQ(frames[5].frame_number, 8U);
}

TEST_F(EmulatedSeekTest, F11ShortAndCutFramesComeWithoutPixelsAndTheNextIsWhole) {
  options_.mutable_expert()->set_stall_timeout_s(10.0);
  for (const char* fault : {"short", "cut"}) {
    SCOPED_TRACE(fault);
    PlugSeek(std::string("2*f f:") + fault + " f");
    const auto source = Open();
    const std::vector<RawFrame> frames = ReadFrames(*source, 6);
    ASSERT_EQ(frames.size(), 6U) << failure_.message();
    for (std::size_t i = 0; i < frames.size(); ++i) {
      EXPECT_EQ(frames[i].pixels.empty(), i == 3) << i;
      if (i > 3) ExpectCounts(frames[i]);
    }
    EXPECT_EQ(source->counts().incomplete, 1U);
    source->Close();
    bus_->Unplug();
  }
}

TEST_F(EmulatedSeekTest, F11LateRestOfAFrameDoesNotShiftTheNextOnes) {
  options_.mutable_expert()->set_stall_timeout_s(10.0);
  PlugSeek("2*f f:late f");
  const auto source = Open();
  const std::vector<RawFrame> frames = ReadFrames(*source, 8);
  ASSERT_EQ(frames.size(), 8U) << failure_.message();
  std::set<std::size_t> without;
  for (std::size_t i = 1; i < frames.size(); ++i) {
    if (frames[i].pixels.empty()) {
      without.insert(i);
    } else {
      ExpectCounts(frames[i]);
    }
  }
  EXPECT_TRUE(without.contains(3));
  EXPECT_LE(without.size(), 2U);
}

TEST_F(EmulatedSeekTest, F05FrozenFramesAreMarkedAndThenTheCameraIsGivenUp) {
  PlugSeek("3*f f:freeze");
  const auto source = Open();
  const std::vector<RawFrame> frames = ReadFrames(*source, 100);
  ASSERT_GT(frames.size(), 5U);
  EXPECT_FALSE(frames[3].shutter_closed);
  EXPECT_TRUE(frames[4].shutter_closed);
  EXPECT_EQ(frames[4].camera_nuc->source, NucSource::kInferred);
  EXPECT_THAT(failure_.message(), HasSubstr("the same image"));
}

TEST_F(EmulatedSeekTest, F04UnpluggedInMidFrameFailsAtOnceAndComesBack) {
  const auto camera = PlugSeek("3*f unplug f");
  const auto source = Open();
  EXPECT_EQ(ReadFrames(*source, 10).size(), 4U);
  EXPECT_EQ(failure_.code(), StatusCode::kUnavailable) << failure_.message();
  source->Close();
  Status opened = source->Open();
  EXPECT_EQ(opened.code(), StatusCode::kUnavailable) << opened.message();
  bus_->Plug(camera);
  opened = source->Open();
  ASSERT_TRUE(opened.ok()) << opened.message();
  EXPECT_EQ(ReadFrames(*source, 3).size(), 3U) << failure_.message();
  EXPECT_EQ(camera->starts(), 2);
}

TEST_F(EmulatedSeekTest, StalledControlEndsTheStreamWithASentence) {
  PlugSeek("2*f stall f");
  const auto source = Open();
  EXPECT_EQ(ReadFrames(*source, 10).size(), 4U);
  EXPECT_EQ(failure_.code(), StatusCode::kIoError);
  EXPECT_THAT(failure_.message(), HasSubstr("asking for a frame"));
  EXPECT_THAT(failure_.message(), HasSubstr("stall"));
  source->Close();
  EXPECT_THAT(source->Open().message(), HasSubstr("waking it up, opcode 84"));
}

TEST_F(EmulatedSeekTest, SilentCameraIsGivenUp) {
  options_.mutable_expert()->set_stall_timeout_s(0.5);
  PlugSeek("2*f -");
  const auto source = Open();
  EXPECT_EQ(ReadFrames(*source, 10).size(), 3U);
  EXPECT_THAT(failure_.message(), HasSubstr("sends nothing"));
}

}  // namespace
}  // namespace isotherm
