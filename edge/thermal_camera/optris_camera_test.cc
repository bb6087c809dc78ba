#include "edge/thermal_camera/optris_camera.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <memory>
#include <utility>
#include <vector>

#include "edge/options/edge_options.pb.h"
#include "edge/thermal_camera/thermal_camera_source.h"

namespace isotherm {
namespace {

using testing::HasSubstr;

/// The driver with a library that has the vendor's interface.
class OptrisCameraTest : public testing::Test {
 protected:
  RawThermalFrame Read(OptrisCamera& camera) {
    Result<std::optional<RawThermalFrame>> frame = camera.Read(Nanoseconds(0));
    EXPECT_TRUE(frame.has_value() && frame->has_value());
    return frame && *frame ? **frame : RawThermalFrame{};
  }
  /// The camera as the edge uses it, in a measuring range.
  std::unique_ptr<ThermalCameraSource> Source(int min_celsius, int max_celsius) {
    settings_.range = {min_celsius, max_celsius};
    ThermalCameraSource::Cameras cameras;
    cameras.list = [] {
      DeviceDescription device;
      device.driver = OptrisCamera::kDriver;
      return Result<std::vector<DeviceDescription>>(std::vector<DeviceDescription>{device});
    };
    cameras.make = [this](const DeviceDescription&) {
      return std::make_unique<OptrisCamera>("1-1", settings_, clock_);
    };
    ThermalCameraOptions options;
    options.set_driver(OPTRIS_SDK);
    return std::make_unique<ThermalCameraSource>(options, clock_, std::move(cameras));
  }
  RawFrame ReadFrame(FrameSource& source) {
    for (int i = 0; i < 20; ++i) {
      Result<SourceItem> item = source.Read({});
      EXPECT_TRUE(item.has_value());
      if (!item) break;
      auto* frame = std::get_if<RawFrame>(&*item);
      if (frame != nullptr && !frame->pixels.empty()) return std::move(*frame);
    }
    ADD_FAILURE() << "no frame";
    return {};
  }
  FakeClock clock_;
  OptrisSettings settings_{FAKE_OPTRIS, "pi450.xml", "", std::nullopt};
};

TEST_F(OptrisCameraTest, FramesHaveTemperaturesClockAndHousekeeping) {
  OptrisCamera camera("1-1", settings_, clock_);
  const Status opened = camera.Open();
  ASSERT_TRUE(opened.ok()) << opened.message();
  EXPECT_EQ(camera.info().serial, "12345");
  EXPECT_EQ(camera.info().width, 4);
  const RawThermalFrame first = Read(camera);
  const RawThermalFrame second = Read(camera);
  // (1251 - 1000) / 10 = 25.1 degrees Celsius.
  const double kelvin = first.encoding.kelvin_per_count * 1'251 + first.encoding.offset_kelvin;
  EXPECT_NEAR(kelvin, 298.25, 1e-9);
  EXPECT_EQ(*second.device_counter - *first.device_counter, 1U);
  EXPECT_EQ(*second.device_ticks - *first.device_ticks, std::chrono::microseconds(37'037));
  EXPECT_EQ(first.nuc->state, NucState::kIdle);
  EXPECT_EQ(first.housekeeping.fpa_celsius, 31.0F);
  EXPECT_EQ(first.housekeeping.shutter_celsius, 32.0F);
  EXPECT_EQ(first.housekeeping.housing_celsius, 33.0F);
}

TEST_F(OptrisCameraTest, ShutterIsFollowedInBand) {
  OptrisCamera camera("1-1", settings_, clock_);
  ASSERT_TRUE(camera.Open().ok());
  ASSERT_TRUE(camera.TriggerNuc().ok());
  for (int i = 0; i < 3; ++i) {
    const RawThermalFrame frame = Read(camera);
    EXPECT_TRUE(frame.shutter_closed);
    EXPECT_EQ(frame.nuc->state, NucState::kInProgress);
  }
  EXPECT_FALSE(Read(camera).shutter_closed);
}

TEST_F(OptrisCameraTest, MissingLibraryCameraOrFunctionIsSaid) {
  OptrisCamera no_library("1-1", {"libnothing_of_the_kind.so", "pi450.xml", "", std::nullopt},
                          clock_);
  EXPECT_THAT(no_library.Open().message(), HasSubstr("optris_library"));
  OptrisCamera other_library("1-1", {"libc.so.6", "pi450.xml", "", std::nullopt}, clock_);
  EXPECT_THAT(other_library.Open().message(), HasSubstr("has no evo_irimager_usb_init"));
  OptrisCamera no_camera("1-1", {FAKE_OPTRIS, "other.xml", "", std::nullopt}, clock_);
  EXPECT_EQ(no_camera.Open().code(), StatusCode::kUnavailable);
}

TEST_F(OptrisCameraTest, MeasuringRangeIsSetAndTold) {
  settings_.range = {0, 250};
  OptrisCamera camera("1-1", settings_, clock_);
  const Status opened = camera.Open();
  ASSERT_TRUE(opened.ok()) << opened.message();
  EXPECT_EQ(camera.info().settings, "range 0 to 250 degrees Celsius");
  // The library corrects after a change of the range.
  EXPECT_TRUE(Read(camera).shutter_closed);

  settings_.range = {0, 251};
  OptrisCamera other("1-1", settings_, clock_);
  EXPECT_THAT(other.Open().message(), HasSubstr("no range of 0 to 251"));
  EXPECT_THAT(camera.SetGain(ThermalGain::kLow).message(), HasSubstr("optris_min_celsius"));
}

TEST_F(OptrisCameraTest, TheThirdRangeReachesBeyond382DegreesInAScaleThatIsAnnounced) {
  const auto source = Source(150, 900);
  const Status opened = source->Open();
  ASSERT_TRUE(opened.ok()) << opened.message();
  const RawFrame frame = ReadFrame(*source);
  ASSERT_FALSE(frame.pixels.empty());
  const float celsius = frame.thermal_scale.Celsius(frame.pixels.At(1, 1));
  EXPECT_GE(celsius, 849.9F);  // 850 to 850.6, in steps of the library.
  EXPECT_LE(celsius, 850.7F);
  EXPECT_GE(frame.thermal_scale.max_celsius(), 900.0);
  EXPECT_LE(frame.thermal_scale.kelvin_per_count, 0.05);
  ASSERT_EQ(source->cameras().size(), 1U);
  EXPECT_EQ(source->cameras()[0].thermal_scale, frame.thermal_scale);
}

TEST_F(OptrisCameraTest, TheOtherRangesStayCentikelvin) {
  for (const auto& [low, high] : {std::pair(-20, 100), std::pair(0, 250)}) {
    const auto source = Source(low, high);
    ASSERT_TRUE(source->Open().ok());
    const RawFrame frame = ReadFrame(*source);
    EXPECT_EQ(frame.thermal_scale, kCentikelvin) << high;
    ASSERT_FALSE(frame.pixels.empty());
    EXPECT_NEAR(frame.thermal_scale.Celsius(frame.pixels.At(0, 0)), 25.3, 0.4);
  }
}

TEST_F(OptrisCameraTest, RangeIsThatOfTheXmlFileUnlessAsked) {
  OptrisCamera camera("1-1", settings_, clock_);
  ASSERT_TRUE(camera.Open().ok());
  EXPECT_EQ(camera.info().settings, "range as in pi450.xml");
  EXPECT_FALSE(Read(camera).shutter_closed);
}

TEST_F(OptrisCameraTest, ClosedCameraRefuses) {
  OptrisCamera camera("1-1", settings_, clock_);
  ASSERT_TRUE(camera.Open().ok());
  camera.Close();
  camera.Close();
  EXPECT_FALSE(camera.Read(Nanoseconds(0)).has_value());
  EXPECT_FALSE(camera.TriggerNuc().ok());
}

}  // namespace
}  // namespace isotherm
