#include "edge/source/blind_detector.h"

#include <gtest/gtest.h>

#include "edge/options/edge_options.pb.h"

namespace isotherm {
namespace {

using std::chrono::milliseconds;

/// 100 x 100 pixels, `valid` of them with a return, at `at_ms`.
RawFrame Frame(int valid, int at_ms) {
  RawFrame frame;
  frame.pixels = Image<std::uint16_t>(100, 100, kNoDepth);
  for (int i = 0; i < 10'000; ++i) {
    if (i < valid) frame.pixels.data()[i] = 700;
    if (i >= valid && i % 2 == 0) frame.pixels.data()[i] = kNoDepthSaturated;
  }
  frame.arrival_wall = CaptureTime(milliseconds(at_ms));
  return frame;
}

TEST(BlindDetectorTest, F13ACoveredCameraIsBlindAfterAWhile) {
  BlindDetector detector{FrameCheckOptions()};  // 2 %, 0.5 s.
  EXPECT_FALSE(detector.Update(Frame(5000, 0)));
  EXPECT_FALSE(detector.Update(Frame(199, 33)));
  EXPECT_FALSE(detector.Update(Frame(0, 532)));
  EXPECT_TRUE(detector.Update(Frame(0, 533)));
  EXPECT_TRUE(detector.Update(Frame(0, 5000)));
}

TEST(BlindDetectorTest, F13ItSeesAgainWithTheFirstFrame) {
  BlindDetector detector{FrameCheckOptions()};
  detector.Update(Frame(0, 0));
  EXPECT_TRUE(detector.Update(Frame(0, 600)));
  EXPECT_FALSE(detector.Update(Frame(200, 633)));
  EXPECT_FALSE(detector.Update(Frame(0, 666))) << "the wait starts again";
}

TEST(BlindDetectorTest, ValidRatioCountsReturns) {
  EXPECT_EQ(ValidRatio(Frame(2500, 0).pixels), 0.25);
  EXPECT_EQ(ValidRatio({}), 0.0);
}

}  // namespace
}  // namespace isotherm
