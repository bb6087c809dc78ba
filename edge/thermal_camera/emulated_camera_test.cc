#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "edge/thermal_camera/testing/camera_fixture.h"
#include "edge/thermal_camera/testing/emulated_lepton.h"
#include "edge/thermal_camera/testing/emulated_p2pro.h"
#include "edge/thermal_camera/testing/emulated_p3.h"

namespace isotherm {
namespace {

using std::chrono::milliseconds;
using testing::HasSubstr;

TEST_F(EmulatedCameraTest, LeptonIsListedWithSerialAndPort) {
  Plug<EmulatedLepton>("f");
  const auto devices = ListThermalCameras();
  ASSERT_TRUE(devices.has_value()) << devices.error().message();
  ASSERT_EQ(devices->size(), 1U);
  EXPECT_EQ(devices->front().driver, "lepton-uvc");
  EXPECT_EQ(devices->front().serial, "LEPTON-1");
  EXPECT_EQ(devices->front().product, "PureThermal (fw:v1.3.0)");
  EXPECT_EQ(devices->front().bus_port, EmulatedBus::kBusPort);
  EXPECT_EQ(devices->front().problem, "");
}

TEST_F(EmulatedCameraTest, LeptonStreamsOverIsochronousTransfers) {
  const auto camera = Plug<EmulatedLepton>("f");
  const auto source = Open();
  const std::vector<RawFrame> frames = ReadFrames(*source, 5);
  ASSERT_EQ(frames.size(), 5U) << failure_.message();
  EXPECT_EQ(camera->alternate(), 1);
  for (const RawFrame& frame : frames) {
    EXPECT_EQ(frame.pixels.height(), 120);
    ExpectRamp(frame, 0.01, EmulatedLepton::kFirstCentikelvin, EmulatedLepton::kNoise);
    EXPECT_EQ(frame.camera_nuc->state, NucState::kIdle);
    EXPECT_NEAR(frame.housekeeping.fpa_celsius, 35.0, 0.01);
    EXPECT_NEAR(frame.housekeeping.housing_celsius, 30.0, 0.01);
  }
  for (std::size_t i = 1; i < frames.size(); ++i) {
    EXPECT_EQ(frames[i].frame_number, i);
    EXPECT_EQ(frames[i].device_ticks - frames[i - 1].device_ticks, milliseconds(115));
    EXPECT_GT(frames[i].arrival_steady, frames[i - 1].arrival_steady);
    EXPECT_GT(frames[i].arrival_wall, frames[i - 1].arrival_wall);
  }
  source->Close();
  EXPECT_EQ(camera->alternate(), 0);
}

TEST_F(EmulatedCameraTest, SourceOpensAgainAfterClosing) {
  Plug<EmulatedLepton>("f");
  const auto source = Open();
  EXPECT_EQ(ReadFrames(*source, 2).size(), 2U);
  source->Close();
  ASSERT_TRUE(source->Open().ok());
  EXPECT_EQ(ReadFrames(*source, 2).size(), 2U) << failure_.message();
}

TEST_F(EmulatedCameraTest, LeptonCorrectsOnOrder) {
  const auto camera = Plug<EmulatedLepton>("f");
  const auto source = Open();
  ASSERT_EQ(ReadFrames(*source, 2).size(), 2U);
  const Status ordered = *source->Control(TriggerNuc{});
  ASSERT_TRUE(ordered.ok()) << ordered.message();
  EXPECT_EQ(camera->corrections(), 1);
  const std::vector<RawFrame> frames = ReadFrames(*source, 12);
  ASSERT_EQ(frames.size(), 12U);
  const auto closed = std::count_if(frames.begin(), frames.end(),
                                    [](const RawFrame& frame) { return frame.shutter_closed; });
  EXPECT_GE(closed, 7);
  EXPECT_LE(closed, 8);
  EXPECT_EQ(frames.back().camera_nuc->state, NucState::kIdle);
  EXPECT_TRUE(source->Control(SetAutomaticNuc{false})->ok());
  EXPECT_EQ(camera->ffc_mode(), 0);
}

TEST_F(EmulatedCameraTest, LeptonTakesItsGainAndItIsReadBack) {
  const auto camera = Plug<EmulatedLepton>("f");
  EXPECT_THAT(Open()->cameras().front().settings, HasSubstr("gain high"));  // As found.
  options_.set_gain(LOW_GAIN);
  {
    const auto source = Open();
    EXPECT_EQ(camera->gain(), 1);
    EXPECT_THAT(source->cameras().front().settings, HasSubstr("gain low"));
    EXPECT_EQ(ReadFrames(*source, 2).size(), 2U) << failure_.message();
  }
  options_.set_gain(HIGH_GAIN);
  camera->KeepGain();
  const Status opened = MakeSource()->Open();
  EXPECT_EQ(opened.code(), StatusCode::kFailedPrecondition);
  EXPECT_THAT(opened.message(), HasSubstr("keeps its gain low and was told high"));
}

TEST_F(EmulatedCameraTest, F04UnpluggedInMidFrameFailsAtOnceAndComesBack) {
  const auto camera = Plug<EmulatedLepton>("3*f unplug f");
  const auto source = Open();
  EXPECT_EQ(ReadFrames(*source, 10).size(), 3U);
  EXPECT_EQ(failure_.code(), StatusCode::kUnavailable);
  EXPECT_THAT(failure_.message(), HasSubstr("unplugged"));
  source->Close();
  Status opened = source->Open();
  EXPECT_EQ(opened.code(), StatusCode::kUnavailable) << opened.message();
  bus_->Plug(camera);
  opened = source->Open();
  ASSERT_TRUE(opened.ok()) << opened.message();
  EXPECT_EQ(ReadFrames(*source, 2).size(), 2U) << failure_.message();
}

TEST_F(EmulatedCameraTest, F05FrozenFramesAreMarkedWithinHalfASecondAndThenTheCameraIsGivenUp) {
  Plug<EmulatedLepton>("3*f f:freeze");
  const auto source = Open();
  const std::vector<RawFrame> frames = ReadFrames(*source, 100);
  ASSERT_GT(frames.size(), 4U);
  for (std::size_t i = 0; i < frames.size(); ++i) EXPECT_EQ(frames[i].shutter_closed, i >= 3);
  // 2 s from the image that stays, of which the first 0.46 s are taken for repeats.
  EXPECT_LE(ToSeconds(frames[3].arrival_steady - frames[2].arrival_steady), 0.5);
  EXPECT_EQ(failure_.code(), StatusCode::kUnavailable);
  EXPECT_THAT(failure_.message(), HasSubstr("the same image"));
}

TEST_F(EmulatedCameraTest, F06RepeatedFramesAreCollapsed) {
  Plug<EmulatedLepton>("f f:freeze f f:freeze f f:freeze f");
  const auto source = Open();
  const std::vector<RawFrame> frames = ReadFrames(*source, 4);
  ASSERT_EQ(frames.size(), 4U);
  EXPECT_EQ(frames.back().frame_number, 3U);
  EXPECT_EQ(source->counts().repeated, 3U);
  EXPECT_EQ(source->counts().lost, 0U);
}

TEST_F(EmulatedCameraTest, F08CorrectionThatNeverEndsIsDeliveredAsThat) {
  Plug<EmulatedLepton>("2*f f:nuc");
  const auto source = Open();
  const std::vector<RawFrame> frames = ReadFrames(*source, 24);
  ASSERT_EQ(frames.size(), 24U) << failure_.message();  // 2.5 s of it.
  for (std::size_t i = 2; i < frames.size(); ++i) EXPECT_TRUE(frames[i].shutter_closed);
}

TEST_F(EmulatedCameraTest, F11DamagedFramesComeWithoutPixels) {
  for (const char* fault : {"short", "head", "error", "lost"}) {
    SCOPED_TRACE(fault);
    Plug<EmulatedLepton>(std::string("2*f f:") + fault + " f");
    const auto source = Open();
    const std::vector<RawFrame> frames = ReadFrames(*source, 5);
    ASSERT_EQ(frames.size(), 5U) << failure_.message();
    for (std::size_t i = 0; i < frames.size(); ++i) {
      EXPECT_EQ(frames[i].pixels.empty(), i == 2) << i;
      EXPECT_EQ(frames[i].frame_number, i);
    }
    EXPECT_EQ(source->counts().incomplete, 1U);
    source->Close();
    bus_->Unplug();
  }
}

TEST_F(EmulatedCameraTest, MissingEndOfFrameCostsNothing) {
  Plug<EmulatedLepton>("f:noeof");
  const auto source = Open();
  EXPECT_EQ(ReadFrames(*source, 4).size(), 4U) << failure_.message();
  EXPECT_EQ(source->counts().incomplete, 0U);
}

TEST_F(EmulatedCameraTest, RenderingsThatWereNotSentAreHoles) {
  Plug<EmulatedLepton>("2*f f:skip f");
  const auto source = Open();
  const std::vector<RawFrame> frames = ReadFrames(*source, 4);
  ASSERT_EQ(frames.size(), 4U);
  EXPECT_EQ(frames[2].frame_number, 5U);
  EXPECT_EQ(source->counts().lost, 3U);
}

TEST_F(EmulatedCameraTest, F09ResetOfTheCameraClockGoesBackwards) {
  Plug<EmulatedLepton>("2*f f:reset f");
  const auto source = Open();
  const std::vector<RawFrame> frames = ReadFrames(*source, 4);
  ASSERT_EQ(frames.size(), 4U);
  EXPECT_LT(frames[2].device_ticks, frames[1].device_ticks);
  EXPECT_GT(frames[3].device_ticks, frames[2].device_ticks);
}

TEST_F(EmulatedCameraTest, RefusedOrdersAreFailuresAndTheStreamGoesOn) {
  Plug<EmulatedLepton>("2*f stall f");
  const auto source = Open();
  ASSERT_EQ(ReadFrames(*source, 3).size(), 3U);
  const Status ordered = *source->Control(TriggerNuc{});
  EXPECT_EQ(ordered.code(), StatusCode::kIoError);
  EXPECT_THAT(ordered.message(), HasSubstr("stall"));
  EXPECT_EQ(ReadFrames(*source, 2).size(), 2U) << failure_.message();
}

TEST_F(EmulatedCameraTest, SilentCameraIsGivenUp) {
  options_.mutable_expert()->set_stall_timeout_s(0.5);
  Plug<EmulatedLepton>("2*f -");
  const auto source = Open();
  EXPECT_EQ(ReadFrames(*source, 3).size(), 2U);
  EXPECT_THAT(failure_.message(), HasSubstr("sends nothing"));
}

TEST_F(EmulatedCameraTest, P2ProStreamsAtHighSpeedAndIsToldNotToCorrectForEmissivity) {
  const auto camera = Plug<EmulatedP2Pro>("f");
  options_.set_gain(LOW_GAIN);
  const auto source = Open();
  EXPECT_THAT(source->cameras().front().settings, HasSubstr("gain low when it answers"));
  const std::vector<RawFrame> frames = ReadFrames(*source, 90);
  ASSERT_EQ(frames.size(), 90U) << failure_.message();
  ExpectRamp(frames[3], 1.0 / 64, EmulatedP2Pro::kFirstCount, EmulatedP2Pro::kNoise);
  EXPECT_FALSE(frames[3].has_device_clock);
  EXPECT_FALSE(frames[3].camera_nuc.has_value());  // It does not answer yet.
  // On a busy computer some are not read in time, and counted.
  EXPECT_EQ(frames.back().frame_number, 89U + source->counts().lost);
  // After three seconds: emissivity and transmission 1, and the shutter is asked.
  EXPECT_EQ(camera->emissivity(), 127);
  EXPECT_EQ(camera->gain(), 0);
  EXPECT_THAT(source->cameras().front().settings, testing::EndsWith("gain low"));  // Read back.
  EXPECT_EQ(frames.back().camera_nuc->source, NucSource::kPolled);
  EXPECT_EQ(frames.back().camera_nuc->state, NucState::kIdle);

  ASSERT_TRUE(source->Control(TriggerNuc{})->ok());
  EXPECT_EQ(camera->corrections(), 1);
  const std::vector<RawFrame> after = ReadFrames(*source, 30);
  ASSERT_EQ(after.size(), 30U) << failure_.message();
  EXPECT_GE(std::count_if(after.begin(), after.end(),
                          [](const RawFrame& frame) { return frame.shutter_closed; }),
            5);
  EXPECT_FALSE(after.back().shutter_closed);
}

TEST_F(EmulatedCameraTest, P2ProFreezesSilentlyWhenItCorrectsItself) {
  // 0.8 s, on a busy computer longer.
  options_.mutable_expert()->set_stall_timeout_s(30.0);
  Plug<EmulatedP2Pro>("5*f 20*f:silent f");
  const auto source = Open();
  const std::vector<RawFrame> frames = ReadFrames(*source, 30);
  ASSERT_EQ(frames.size(), 30U) << failure_.message();
  // A busy computer may not read each of the 20 in time, and counts those that it does not.
  const ThermalCameraCounts& counts = source->counts();
  EXPECT_LE(counts.repeated, 3U);
  EXPECT_LE(counts.repeated + counts.frozen, 20U);
  EXPECT_GE(counts.repeated + counts.frozen + counts.lost, 20U);
  EXPECT_TRUE(frames[10].shutter_closed);
  EXPECT_EQ(frames[10].camera_nuc->state, NucState::kInProgress);
  EXPECT_EQ(frames[10].camera_nuc->source, NucSource::kInferred);
  EXPECT_FALSE(frames.back().shutter_closed);
}

TEST_F(EmulatedCameraTest, P2ProColdStartGivesNoFrames) {
  Plug<EmulatedP2Pro>("60*f:cold f");
  const auto source = Open();
  const std::vector<RawFrame> frames = ReadFrames(*source, 3);
  ASSERT_EQ(frames.size(), 3U) << failure_.message();
  EXPECT_EQ(frames[0].camera_nuc->state, NucState::kSettling);
}

TEST_F(EmulatedCameraTest, P3StreamsOverBulkTransfers) {
  const auto camera = Plug<EmulatedP3>("5*f f:partial 2*f f:skip 3*f 10*f:nuc f");
  options_.set_gain(LOW_GAIN);
  const auto source = Open();
  EXPECT_EQ(camera->gain(), 0);
  const std::vector<RawFrame> frames = ReadFrames(*source, 26);
  ASSERT_EQ(frames.size(), 26U) << failure_.message();
  EXPECT_EQ(camera->alternate(), 1);
  ExpectRamp(frames[0], 1.0 / 64, EmulatedP3::kFirstCount, EmulatedP3::kNoise);
  EXPECT_EQ(frames[1].device_ticks - frames[0].device_ticks, milliseconds(40));
  EXPECT_TRUE(frames[5].pixels.empty());  // The piece; the whole frame behind it is good.
  EXPECT_FALSE(frames[6].pixels.empty());
  EXPECT_EQ(source->counts().lost, 3U);
  EXPECT_EQ(std::count_if(frames.begin(), frames.end(),
                          [](const RawFrame& frame) { return frame.shutter_closed; }),
            10);
  EXPECT_TRUE(source->Control(TriggerNuc{})->ok());
  EXPECT_EQ(camera->corrections(), 1);
  source->Close();
  EXPECT_EQ(camera->alternate(), 0);
}

TEST_F(EmulatedCameraTest, F04P3UnpluggedInMidFrame) {
  Plug<EmulatedP3>("3*f unplug");
  const auto source = Open();
  EXPECT_EQ(ReadFrames(*source, 10).size(), 3U);
  EXPECT_EQ(failure_.code(), StatusCode::kUnavailable);
  EXPECT_THAT(failure_.message(), HasSubstr("unplugged"));
}

TEST_F(EmulatedCameraTest, CameraThatRefusesToAgreeOnAModeSaysSo) {
  const auto camera = Plug<EmulatedLepton>("f stall f");
  {
    const auto source = Open();
    ASSERT_EQ(ReadFrames(*source, 2).size(), 2U);
  }
  const Status opened = MakeSource()->Open();
  EXPECT_EQ(opened.code(), StatusCode::kIoError);
  EXPECT_THAT(opened.message(), HasSubstr("agreeing on a mode"));
}

}  // namespace
}  // namespace isotherm
