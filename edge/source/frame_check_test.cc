#include "edge/source/frame_check.h"

#include <gtest/gtest.h>

#include "edge/options/edge_options.pb.h"

namespace isotherm {
namespace {

RawFrame Frame(Sensor sensor, int width, int height, std::uint16_t value) {
  RawFrame frame;
  frame.sensor = sensor;
  frame.pixels = Image<std::uint16_t>(width, height, value);
  return frame;
}

class FrameCheckTest : public testing::Test {
 protected:
  FrameCheck check_{FrameCheckOptions()};
};

TEST_F(FrameCheckTest, F11AFrameWithoutPixelsIsRefused) {
  RawFrame frame = Frame(Sensor::kDepth, 0, 0, 0);
  EXPECT_EQ(check_.Process(frame).code(), StatusCode::kDataLoss);
}

TEST_F(FrameCheckTest, F11AFrameOfAnotherSizeThanTheFirstIsRefused) {
  RawFrame first = Frame(Sensor::kDepth, 640, 480, 700);
  ASSERT_TRUE(check_.Process(first).ok());
  RawFrame narrow = Frame(Sensor::kDepth, 320, 480, 700);
  const Status status = check_.Process(narrow);
  EXPECT_EQ(status.code(), StatusCode::kDataLoss);
  EXPECT_NE(status.message().find("320x480 pixels instead of 640x480"), std::string::npos);
  RawFrame good = Frame(Sensor::kDepth, 640, 480, 700);
  EXPECT_TRUE(check_.Process(good).ok());
}

TEST_F(FrameCheckTest, F11TheCalibrationDecidesTheSizeIfThereIsOne) {
  Rig rig;
  rig.thermal.emplace();
  rig.thermal->width = 382;
  rig.thermal->height = 288;
  check_.Expect(rig);
  RawFrame wrong = Frame(Sensor::kThermal, 160, 120, 29'815);
  EXPECT_FALSE(check_.Process(wrong).ok());
  RawFrame right = Frame(Sensor::kThermal, 382, 288, 29'815);
  EXPECT_TRUE(check_.Process(right).ok());
  RawFrame depth_is_free = Frame(Sensor::kDepth, 256, 192, 700);
  EXPECT_TRUE(check_.Process(depth_is_free).ok());
}

TEST_F(FrameCheckTest, F12TemperaturesOutOfRangeBecomeNoValue) {
  RawFrame frame = Frame(Sensor::kThermal, 4, 1, 29'815);
  frame.pixels.At(0, 0) = 0;
  frame.pixels.At(1, 0) = 65'535;
  frame.pixels.At(2, 0) = 1'000;  // 10 K
  ASSERT_TRUE(check_.Process(frame).ok());
  EXPECT_EQ(frame.pixels.At(0, 0), 0);
  EXPECT_EQ(frame.pixels.At(1, 0), 0);
  EXPECT_EQ(frame.pixels.At(2, 0), 0);
  EXPECT_EQ(frame.pixels.At(3, 0), 29'815);
  EXPECT_EQ(check_.masked_pixels(), 3U);
}

TEST_F(FrameCheckTest, CountsAreNoTemperaturesAndStayAsTheyAre) {
  check_.KeepCounts(true);
  RawFrame frame = Frame(Sensor::kThermal, 4, 1, 1'000);
  ASSERT_TRUE(check_.Process(frame).ok());
  EXPECT_EQ(frame.pixels.At(2, 0), 1'000);
  EXPECT_EQ(check_.masked_pixels(), 0U);
}

TEST_F(FrameCheckTest, F12TemperaturesAtTheLimitsAreKept) {
  FrameCheckOptions options;
  options.mutable_expert()->set_min_celsius(0);
  options.mutable_expert()->set_max_celsius(100);
  FrameCheck check(options);
  RawFrame frame = Frame(Sensor::kThermal, 4, 1, 0);
  frame.pixels.At(0, 0) = 27'314;
  frame.pixels.At(1, 0) = 27'315;
  frame.pixels.At(2, 0) = 37'315;
  frame.pixels.At(3, 0) = 37'316;
  ASSERT_TRUE(check.Process(frame).ok());
  EXPECT_EQ(frame.pixels.At(0, 0), 0);
  EXPECT_EQ(frame.pixels.At(1, 0), 27'315);
  EXPECT_EQ(frame.pixels.At(2, 0), 37'315);
  EXPECT_EQ(frame.pixels.At(3, 0), 0);
}

TEST_F(FrameCheckTest, F12LimitsAreTemperaturesWhateverTheScale) {
  FrameCheckOptions options;
  options.mutable_expert()->set_min_celsius(0);
  options.mutable_expert()->set_max_celsius(900);
  FrameCheck check(options);
  RawFrame frame = Frame(Sensor::kThermal, 4, 1, 0);
  frame.thermal_scale = {0.02, 0.0};
  frame.pixels.At(0, 0) = 13'600;  // -1.15 °C.
  frame.pixels.At(1, 0) = 56'157;  // 849.99 °C.
  frame.pixels.At(2, 0) = 58'657;  // 899.99 °C.
  frame.pixels.At(3, 0) = 58'700;  // 900.85 °C.
  ASSERT_TRUE(check.Process(frame).ok());
  EXPECT_EQ(frame.pixels.At(0, 0), 0);
  EXPECT_EQ(frame.pixels.At(1, 0), 56'157);
  EXPECT_EQ(frame.pixels.At(2, 0), 58'657);
  EXPECT_EQ(frame.pixels.At(3, 0), 0);
}

TEST_F(FrameCheckTest, F12DepthWithoutReturnStaysAsItIs) {
  RawFrame frame = Frame(Sensor::kDepth, 2, 1, kNoDepth);
  frame.pixels.At(1, 0) = kNoDepthSaturated;
  ASSERT_TRUE(check_.Process(frame).ok());
  EXPECT_EQ(frame.pixels.At(0, 0), kNoDepth);
  EXPECT_EQ(frame.pixels.At(1, 0), kNoDepthSaturated);
}

}  // namespace
}  // namespace isotherm
