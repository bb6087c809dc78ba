#include "edge/thermal_camera/optris_camera.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

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
