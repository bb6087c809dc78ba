#include "edge/thermal_camera/thermal_camera_source.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <deque>
#include <functional>

#include "edge/options/edge_options.pb.h"
#include "edge/thermal_camera/testing/scripted_camera.h"

namespace isotherm {
namespace {

using std::chrono::milliseconds;
using ::testing::HasSubstr;
using testing::Script;
using testing::ScriptedCamera;

class ThermalCameraSourceTest : public ::testing::Test {
 protected:
  ThermalCameraSourceTest() {
    device_.driver = "lepton-uvc";
    device_.serial = "A1";
    device_.bus_port = "1-2";
    script_.info.driver = "lepton-uvc";
    script_.info.serial = "A1";
    script_.info.width = 2;
    script_.info.height = 1;
    script_.info.counter_step = 3;
  }

  std::unique_ptr<ThermalCameraSource> Open() {
    auto source = Make();
    const Status opened = source->Open();
    EXPECT_TRUE(opened.ok()) << opened.message();
    return source;
  }
  std::unique_ptr<ThermalCameraSource> Make() {
    ThermalCameraSource::Cameras cameras;
    cameras.list = [this] { return devices(); };
    cameras.make = [this](const DeviceDescription& device) {
      script_.info.serial = device.serial;
      return std::make_unique<ScriptedCamera>(script_, clock_);
    };
    return std::make_unique<ThermalCameraSource>(options_, clock_, cameras);
  }
  Result<std::vector<DeviceDescription>> devices() const {
    return std::vector<DeviceDescription>{device_};
  }

  RawThermalFrame MakeFrame(std::uint16_t count, std::uint64_t counter) const {
    RawThermalFrame frame;
    frame.counts = Image<std::uint16_t>(2, 1, count);
    frame.encoding = {true, 0.01, 0.0};
    frame.device_counter = counter;
    frame.device_ticks = DeviceTicks(milliseconds(counter));
    frame.nuc = CameraNuc{NucState::kIdle, NucSource::kInBand, 4.0};
    return frame;
  }
  void Send(const RawThermalFrame& frame) {
    script_.reads.push_back([frame] { return std::optional(frame); });
  }
  /// The next item; a failure of Read ends the test's patience.
  SourceItem Read(FrameSource& source) {
    Result<SourceItem> item = source.Read({});
    if (!item) {
      failure_ = item.error();
      return EndOfStream{};
    }
    return *item;
  }
  RawFrame ReadFrame(FrameSource& source) {
    const SourceItem item = Read(source);
    EXPECT_TRUE(std::holds_alternative<RawFrame>(item)) << failure_.message();
    return std::holds_alternative<RawFrame>(item) ? std::get<RawFrame>(item) : RawFrame{};
  }

  FakeClock clock_{CaptureTime(std::chrono::hours(1))};
  ThermalCameraOptions options_;
  DeviceDescription device_;
  Script script_;
  Status failure_;
};

TEST_F(ThermalCameraSourceTest, FrameCarriesTimesStateAndTemperatures) {
  RawThermalFrame sent = MakeFrame(29'815, 100);
  sent.housekeeping.housing_celsius = 31.0F;
  Send(sent);
  const auto source = Open();
  const RawFrame frame = ReadFrame(*source);
  EXPECT_EQ(frame.sensor, Sensor::kThermal);
  EXPECT_EQ(frame.frame_number, 0U);
  EXPECT_TRUE(frame.has_device_clock);
  EXPECT_EQ(frame.device_ticks, DeviceTicks(milliseconds(100)));
  EXPECT_EQ(frame.arrival_wall, clock_.Now());
  EXPECT_EQ(frame.arrival_steady, clock_.SteadyNow());
  EXPECT_EQ(frame.pixels.At(1, 0), 29'815);
  EXPECT_EQ(frame.camera_nuc->state, NucState::kIdle);
  EXPECT_EQ(frame.housekeeping.housing_celsius, 31.0F);
  EXPECT_FALSE(frame.shutter_closed);
}

TEST_F(ThermalCameraSourceTest, CountsBecomeCentikelvinOrNoValue) {
  RawThermalFrame sent = MakeFrame(0, 100);
  sent.encoding = {true, 1.0 / 64, 0.0};
  sent.counts = Image<std::uint16_t>(4, 1);
  sent.counts.At(0, 0) = 19'082;  // 298.156 K.
  sent.counts.At(1, 0) = 0;
  sent.counts.At(2, 0) = 41'942;  // 655.344 K is the last that fits: 65534.
  sent.counts.At(3, 0) = 41'943;  // 655.359 K would be 65536.
  Send(sent);
  const RawFrame frame = ReadFrame(*Open());
  EXPECT_EQ(frame.pixels.At(0, 0), 29'816);
  EXPECT_EQ(frame.pixels.At(1, 0), 0);
  EXPECT_EQ(frame.pixels.At(2, 0), 65'534);
  EXPECT_EQ(frame.pixels.At(3, 0), 0);
}

TEST_F(ThermalCameraSourceTest, TheCamerasRangeDecidesTheScaleWhichStaysAndIsTold) {
  script_.info.range = MeasuringRange{150.0, 900.0};
  RawThermalFrame sent = MakeFrame(10'000, 100);
  sent.encoding = {true, 0.1, kCelsiusZero_k - 100.0};  // 900 °C.
  Send(sent);
  const auto source = Open();
  const RawFrame frame = ReadFrame(*source);
  EXPECT_EQ(frame.thermal_scale, (RadiometricScale{0.02, 0.0}));
  EXPECT_NEAR(frame.thermal_scale.Celsius(frame.pixels.At(0, 0)), 900.0, 0.011);
  EXPECT_EQ(source->cameras().at(0).thermal_scale, frame.thermal_scale);
  // Announced is announced: what it says when it is opened again does not matter.
  script_.info.range = MeasuringRange{0.0, 250.0};
  source->Close();
  ASSERT_TRUE(source->Open().ok());
  EXPECT_EQ(source->cameras().at(0).thermal_scale, frame.thermal_scale);
}

TEST_F(ThermalCameraSourceTest, ARangeThatNoScaleOf16BitsHoldsIsRefused) {
  script_.info.range = MeasuringRange{150.0, 4'000.0};
  const Status opened = Make()->Open();
  EXPECT_EQ(opened.code(), StatusCode::kInvalidArgument);
  EXPECT_THAT(opened.message(), HasSubstr("4000 °C"));
}

TEST_F(ThermalCameraSourceTest, WhatTheOptionsMakeOfCountsIsNotCutAt382Degrees) {
  options_.mutable_expert()->set_kelvin_per_count(0.04);
  options_.mutable_expert()->set_offset_kelvin(-20.0);
  RawThermalFrame sent = MakeFrame(30'000, 100);  // 1180 K.
  sent.encoding = {};
  // A Lepton knows its range, whether or not it sends temperatures.
  for (const auto& range : {std::optional<MeasuringRange>(), {MeasuringRange{-10.0, 140.0}}}) {
    script_.info.counts_only = !range;
    script_.info.range = range;
    Send(sent);
    const RawFrame frame = ReadFrame(*Open());
    EXPECT_NEAR(frame.thermal_scale.Celsius(frame.pixels.At(0, 0)), 906.85, 0.03);
  }
}

TEST_F(ThermalCameraSourceTest, CountsWithoutTemperatureAreRefusedUnlessTheOptionsRelateThem) {
  RawThermalFrame sent = MakeFrame(8'000, 100);
  sent.encoding = {};
  Send(sent);
  Read(*Open());
  EXPECT_EQ(failure_.code(), StatusCode::kFailedPrecondition);
  EXPECT_THAT(failure_.message(), HasSubstr("kelvin_per_count"));

  options_.mutable_expert()->set_kelvin_per_count(0.04);
  options_.mutable_expert()->set_offset_kelvin(-20.0);
  Send(sent);
  const RawFrame frame = ReadFrame(*Open());
  EXPECT_NEAR(frame.thermal_scale.Kelvin(frame.pixels.At(0, 0)), 300.0, 1e-9);
}

TEST_F(ThermalCameraSourceTest, F11AWrongBitOfTheEncodingCostsItsFrameAndNothingElse) {
  Send(MakeFrame(1, 100));
  RawThermalFrame wrong = MakeFrame(2, 103);
  wrong.encoding.radiometric = false;
  Send(wrong);
  Send(MakeFrame(3, 106));
  const auto source = Open();
  ReadFrame(*source);
  const RawFrame refused = ReadFrame(*source);
  EXPECT_TRUE(refused.pixels.empty()) << "its counts are not taken for temperatures";
  EXPECT_EQ(refused.frame_number, 1U);
  const RawFrame next = ReadFrame(*source);
  EXPECT_FALSE(next.pixels.empty());
  EXPECT_EQ(next.frame_number, 2U);
  EXPECT_EQ(source->counts().lost, 0U);
  EXPECT_EQ(script_.opened, 1);
}

TEST_F(ThermalCameraSourceTest, LostFramesLeaveHolesInTheNumbers) {
  Send(MakeFrame(1, 100));
  Send(MakeFrame(2, 109));
  Send(MakeFrame(3, 112));
  const auto source = Open();
  EXPECT_EQ(ReadFrame(*source).frame_number, 0U);
  EXPECT_EQ(ReadFrame(*source).frame_number, 3U);
  EXPECT_EQ(ReadFrame(*source).frame_number, 4U);
  EXPECT_EQ(source->counts().lost, 2U);
}

TEST_F(ThermalCameraSourceTest, F06NativeDuplicatesAreLeftOutAndNoLoss) {
  Send(MakeFrame(1, 100));
  Send(MakeFrame(1, 100));
  Send(MakeFrame(2, 103));
  const auto source = Open();
  EXPECT_EQ(ReadFrame(*source).frame_number, 0U);
  EXPECT_TRUE(std::holds_alternative<NothingYet>(Read(*source)));
  EXPECT_EQ(ReadFrame(*source).frame_number, 1U);
  EXPECT_EQ(source->counts().repeated, 1U);
  EXPECT_EQ(source->counts().lost, 0U);
}

TEST_F(ThermalCameraSourceTest, F05FrozenFramesAreNotGoodAndThenTheCameraIsReopened) {
  for (int i = 0; i < 40; ++i) Send(MakeFrame(1, 100));
  const auto source = Open();
  EXPECT_FALSE(ReadFrame(*source).shutter_closed);
  for (int i = 0; i < 2; ++i) EXPECT_TRUE(std::holds_alternative<NothingYet>(Read(*source)));
  // Known within half a second, ...
  const RawFrame frozen = ReadFrame(*source);
  EXPECT_TRUE(frozen.shutter_closed);
  EXPECT_EQ(frozen.camera_nuc->state, NucState::kError);
  EXPECT_EQ(frozen.camera_nuc->source, NucSource::kInferred);
  // ... given up after two.
  int frames = 1;
  while (std::holds_alternative<RawFrame>(Read(*source))) ++frames;
  EXPECT_EQ(frames, 17);  // From 0.3 to 1.9 s.
  EXPECT_EQ(failure_.code(), StatusCode::kUnavailable);
  EXPECT_THAT(failure_.message(), HasSubstr("the same image"));
}

TEST_F(ThermalCameraSourceTest, FrozenImageOfASilentCameraIsACorrection) {
  script_.info.counter_step = 0;
  for (int i = 0; i < 5; ++i) {
    RawThermalFrame frame = MakeFrame(1, 0);
    frame.nuc.reset();
    Send(frame);
  }
  const auto source = Open();
  for (int i = 0; i < 3; ++i) Read(*source);
  EXPECT_EQ(ReadFrame(*source).camera_nuc->state, NucState::kInProgress);
}

TEST_F(ThermalCameraSourceTest, FramesThatWereNotReadInTimeAreCountedOnce) {
  for (const int counter_step : {0, 3}) {
    script_.info.counter_step = counter_step;
    RawThermalFrame first = MakeFrame(1, 100), second = MakeFrame(2, 109);
    if (counter_step == 0) first.device_counter = second.device_counter = std::nullopt;
    second.dropped_before = 2;
    Send(first);
    Send(second);
    const auto source = Open();
    EXPECT_EQ(ReadFrame(*source).frame_number, 0U);
    EXPECT_EQ(ReadFrame(*source).frame_number, 3U);
    EXPECT_EQ(source->counts().lost, 2U) << "counter step " << counter_step;
  }
}

TEST_F(ThermalCameraSourceTest, F08CorrectionThatNeverEndsIsDeliveredAsThat) {
  for (int i = 0; i < 50; ++i) {
    RawThermalFrame frame = MakeFrame(1, 100);
    frame.nuc->state = NucState::kInProgress;
    frame.shutter_closed = true;
    Send(frame);
  }
  const auto source = Open();
  for (int i = 0; i < 50; ++i) EXPECT_TRUE(ReadFrame(*source).shutter_closed);
}

TEST_F(ThermalCameraSourceTest, F11IncompleteFramesComeWithoutPixels) {
  Send(MakeFrame(1, 100));
  RawThermalFrame incomplete;
  incomplete.counts = Image<std::uint16_t>(2, 1, 7);
  incomplete.incomplete = true;
  Send(incomplete);
  Send(MakeFrame(2, 106));
  const auto source = Open();
  ReadFrame(*source);
  const RawFrame refused = ReadFrame(*source);
  EXPECT_TRUE(refused.pixels.empty());
  EXPECT_EQ(refused.frame_number, 1U);
  EXPECT_EQ(source->counts().incomplete, 1U);
}

TEST_F(ThermalCameraSourceTest, F04SilentCameraFailsAfterTheTimeout) {
  options_.mutable_expert()->set_stall_timeout_s(1.0);
  const auto source = Open();
  for (int i = 0; i < 9; ++i) EXPECT_TRUE(std::holds_alternative<NothingYet>(Read(*source)));
  Read(*source);
  EXPECT_EQ(failure_.code(), StatusCode::kUnavailable);
  EXPECT_THAT(failure_.message(), HasSubstr("sends nothing"));
}

TEST_F(ThermalCameraSourceTest, F03ConfiguredSerialRefusesAnotherCamera) {
  options_.set_serial("B7");
  const Status opened = Make()->Open();
  EXPECT_EQ(opened.code(), StatusCode::kFailedPrecondition);
  EXPECT_THAT(opened.message(), HasSubstr("\"B7\" is not connected"));
  EXPECT_THAT(opened.message(), HasSubstr("lepton-uvc with serial \"A1\" at 1-2"));
  EXPECT_EQ(script_.opened, 0);
}

TEST_F(ThermalCameraSourceTest, F03ReplugWithAnotherSerialIsRefused) {
  const auto source = Open();
  device_.serial = "B7";
  EXPECT_EQ(source->Open().code(), StatusCode::kFailedPrecondition);
  device_.serial = "A1";
  device_.bus_port = "1-4";
  EXPECT_TRUE(source->Open().ok());
}

TEST_F(ThermalCameraSourceTest, TheVendorsLibraryIsUsedOnlyIfNamed) {
  device_.driver = "optris-sdk";
  EXPECT_EQ(Make()->Open().code(), StatusCode::kUnavailable);
  options_.set_driver(OPTRIS_SDK);
  EXPECT_TRUE(Make()->Open().ok());
}

TEST_F(ThermalCameraSourceTest, CameraWithoutTemperaturesSendsCountsUnlessTheOptionsRelateThem) {
  script_.info.counts_only = true;
  RawThermalFrame sent = MakeFrame(8'000, 100);
  sent.encoding = {};
  Send(sent);
  const auto source = Open();
  EXPECT_TRUE(source->cameras().front().counts_only);
  EXPECT_EQ(ReadFrame(*source).pixels.At(0, 0), 8'000);
  options_.mutable_expert()->set_kelvin_per_count(0.04);
  Send(sent);
  const auto related = Open();
  EXPECT_FALSE(related->cameras().front().counts_only);
  const RawFrame frame = ReadFrame(*related);
  EXPECT_NEAR(frame.thermal_scale.Celsius(frame.pixels.At(0, 0)), 320.0 - 273.15, 1e-3);
}

TEST_F(ThermalCameraSourceTest, NoCameraIsUnavailable) {
  options_.mutable_expert()->set_bus_port("2-1");
  const Status opened = Make()->Open();
  EXPECT_EQ(opened.code(), StatusCode::kUnavailable);
  EXPECT_THAT(opened.message(), HasSubstr("no thermal camera at 2-1"));
}

TEST_F(ThermalCameraSourceTest, CameraThatMayNotBeOpenedSaysWhy) {
  device_.problem = "opening it: Access denied";
  EXPECT_THAT(Make()->Open().message(), HasSubstr("Access denied"));
}

TEST_F(ThermalCameraSourceTest, DescribesTheOpenedCamera) {
  const auto source = Make();
  EXPECT_TRUE(source->cameras().empty());
  ASSERT_TRUE(source->Open().ok());
  ASSERT_EQ(source->cameras().size(), 1U);
  EXPECT_EQ(source->cameras()[0].sensor, Sensor::kThermal);
  EXPECT_EQ(source->cameras()[0].serial, "A1");
  EXPECT_EQ(source->cameras()[0].width, 2);
}

TEST_F(ThermalCameraSourceTest, OrdersReachTheCamera) {
  options_.set_gain(LOW_GAIN);
  const auto source = Open();
  EXPECT_EQ(script_.gain, ThermalGain::kLow);
  EXPECT_TRUE(source->Control(TriggerNuc{})->ok());
  EXPECT_EQ(script_.corrections, 1);
  EXPECT_FALSE(source->Control(SetAutomaticNuc{false})->ok());
  source->Close();
  EXPECT_EQ(source->Control(TriggerNuc{})->code(), StatusCode::kUnavailable);
}

}  // namespace
}  // namespace isotherm
