#include "ground/camera_calibration/still_poses.h"

#include <gtest/gtest.h>

#include <cmath>

#include "common/base/noise.h"

namespace isotherm {
namespace {

constexpr float kNoise = 5.0F;

/// A bright square whose left edge is at `left_px`, with noise.
Image<float> Square(double left_px, std::uint64_t stream, float offset = 0.0F) {
  Image<float> image(80, 60);
  std::uint64_t counter = 0;
  for (int y = 0; y < image.height(); ++y) {
    for (int x = 0; x < image.width(); ++x) {
      const double inside =
          std::clamp(x + 0.5 - left_px, 0.0, 1.0) - std::clamp(x + 0.5 - left_px - 30.0, 0.0, 1.0);
      image.At(x, y) = 3000.0F + offset +
                       (y > 10 && y < 50 ? 1000.0F * static_cast<float>(inside) : 0.0F) +
                       kNoise * NormalNoise(stream, counter++);
    }
  }
  return image;
}

TEST(StillPosesTest, ImagesOfOnePoseLookAlikeWhateverTheirOffset) {
  EXPECT_TRUE(LookAlike(Square(20.0, 1), Square(20.0, 2)));
  EXPECT_TRUE(LookAlike(Square(20.0, 1), Square(20.0, 2, 40.0F)));
}

TEST(StillPosesTest, AnEdgeThatMovesByATenthOfAPixelIsNoticed) {
  EXPECT_FALSE(LookAlike(Square(20.0, 1), Square(20.1, 2)));
  EXPECT_FALSE(LookAlike(Square(20.0, 1), Square(25.0, 2)));
  // Where most of the image changes, nothing is left to compare with.
  Image<float> inverted = Square(20.0, 1);
  for (float& value : inverted.pixels()) value = 7000.0F - value;
  EXPECT_FALSE(LookAlike(Square(20.0, 1), inverted));
  EXPECT_FALSE(LookAlike(Square(20.0, 1), Image<float>(40, 60, 0.0F)));
}

TEST(StillPosesTest, TwoRestsGiveTwoPosesAndMotionNone) {
  StillPoseFinder finder({.min_frames = 5, .max_frames = 40});
  std::vector<StillPose> poses;
  std::uint64_t stream = 0;
  double time_s = 0.0;
  const auto add = [&](double left_px) {
    if (auto pose = finder.Add(time_s += 0.025, Square(left_px, ++stream))) poses.push_back(*pose);
  };
  for (int i = 0; i < 12; ++i) add(20.0);
  for (int i = 0; i < 10; ++i) add(20.0 + i);
  for (int i = 0; i < 3; ++i) add(35.0);  // Too short.
  for (int i = 0; i < 8; ++i) add(10.5);
  if (auto pose = finder.Finish()) poses.push_back(*pose);
  ASSERT_EQ(poses.size(), 2U);
  EXPECT_GE(poses[0].frames, 12);
  EXPECT_EQ(poses[1].frames, 8);
  EXPECT_NEAR(poses[0].begin_s, 0.025, 1e-9);
  // The mean has less noise than a frame.
  double squares = 0.0;
  for (int x = 60; x < 80; ++x)
    for (int y = 0; y < 60; ++y)
      squares += std::pow(static_cast<double>(poses[0].mean.At(x, y)) - 3000.0, 2);
  EXPECT_LT(std::sqrt(squares / 1200.0), 0.5 * static_cast<double>(kNoise));
  EXPECT_GE(poses[0].samples.size(), 2U);
}

/// A board with holes 13 mm before a plate, millimetres; which of both their rims show flickers.
Image<float> HolesInDepth(double shift_px, std::uint64_t stream) {
  Image<float> image(160, 120);
  std::uint64_t counter = 0;
  for (int y = 0; y < image.height(); ++y) {
    for (int x = 0; x < image.width(); ++x) {
      constexpr double kPitch_px = 20.0, kRadius_px = 6.0, kWander_px = 0.7;
      const auto wander = kWander_px * static_cast<double>(NormalNoise(stream, counter++));
      const double u = std::fmod(x + shift_px + 2.0 * kPitch_px, kPitch_px) - 0.5 * kPitch_px;
      const double v = std::fmod(y + 0.5, kPitch_px) - 0.5 * kPitch_px;
      const float depth = std::hypot(u, v) + wander < kRadius_px ? 713.0F : 700.0F;
      image.At(x, y) = depth + NormalNoise(stream, counter++);
    }
  }
  return image;
}

TEST(StillPosesTest, RimsThatFlickerInDepthAreNoMotion) {
  const auto frames = [](double per_frame_px) {
    StillPoseFinder finder({.min_frames = 8, .is_depth = true});
    int longest = 0;
    for (int i = 0; i < 10; ++i) {
      finder.Add(i, HolesInDepth(per_frame_px * i, static_cast<std::uint64_t>(i)));
      longest = std::max(longest, finder.frames());
    }
    return longest;
  };
  EXPECT_EQ(frames(0.0), 10);
  EXPECT_LT(frames(0.3), 8) << "three pixels in ten frames";
  EXPECT_LT(frames(2.0), 4);
  StillPoseFinder finder({.min_frames = 8, .is_depth = true});
  for (int i = 0; i < 9; ++i) finder.Add(i, HolesInDepth(0.0, static_cast<std::uint64_t>(i)));
  const auto pose = finder.Finish();
  ASSERT_TRUE(pose.has_value());
  EXPECT_EQ(pose->samples.size(), 8U) << "each is needed for the rims";
}

TEST(StillPosesTest, ImagesOfOnePoseEachAreNotTakenForOnePose) {
  StillPoseFinder finder({.min_frames = 1, .is_depth = true});
  int poses = 0;
  for (const double shift_px : {0.0, 3.0, 8.0, 5.0})
    poses += finder.Add(shift_px, HolesInDepth(shift_px, 7)).has_value() ? 1 : 0;
  poses += finder.Finish().has_value() ? 1 : 0;
  EXPECT_EQ(poses, 4);
}

TEST(StillPosesTest, PixelsWithoutDepthAreNoMotion) {
  Image<float> holes = HolesInDepth(0.0, 1), other = HolesInDepth(0.0, 2);
  for (std::size_t i = 0; i < holes.size(); i += 3) holes.pixels()[i] = std::nanf("");
  for (std::size_t i = 1; i < other.size(); i += 4) other.pixels()[i] = std::nanf("");
  EXPECT_LT(MovedFraction(holes, other), 0.005);
  EXPECT_EQ(MovedFraction(holes, Image<float>(80, 60, 700.0F)), 1.0);
}

TEST(StillPosesTest, OfALongRestTheFirstFramesCount) {
  StillPoseFinder finder({.min_frames = 5, .max_frames = 10});
  for (int i = 0; i < 30; ++i)
    EXPECT_FALSE(finder.Add(i, Square(20.0, static_cast<std::uint64_t>(i))).has_value());
  const auto pose = finder.Finish();
  ASSERT_TRUE(pose.has_value());
  EXPECT_EQ(pose->frames, 10);
  EXPECT_DOUBLE_EQ(pose->end_s, 29.0);
}

}  // namespace
}  // namespace isotherm
