#include "edge/nuc/picture_watch.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "common/testing/test_seed.h"
#include "edge/options/edge_options.pb.h"

namespace isotherm {
namespace {

using Picture = Image<std::uint16_t>;

constexpr double kNoiseK = 0.05;

class PictureWatchTest : public ::testing::Test {
 protected:
  /// A ramp from 293 K with noise.
  Picture Scene(double range_k) {
    std::normal_distribution<double> noise(0.0, 100.0 * kNoiseK);
    Picture picture(96, 72);
    for (int y = 0; y < picture.height(); ++y) {
      for (int x = 0; x < picture.width(); ++x) {
        picture.At(x, y) = static_cast<std::uint16_t>(
            29'300.0 + 100.0 * range_k * x / picture.width() + noise(random_) + 0.5);
      }
    }
    return picture;
  }
  PictureEvidence Add(const Picture& picture, bool known_closed = false) {
    now_ += std::chrono::milliseconds(25);
    return watch_.Add(picture, now_, known_closed);
  }

  std::mt19937 random_{testing::Seed()};
  NucOptions options_;
  PictureWatch watch_{options_};
  CaptureTime now_{std::chrono::hours(1)};
};

TEST_F(PictureWatchTest, SpreadIsTheStandardDeviationInKelvin) {
  // Of a ramp over 12 K: 12 / sqrt(12). The noise adds nothing that shows.
  EXPECT_NEAR(PictureSpread(Scene(12.0)), 12.0 / std::sqrt(12.0), 0.1);
  EXPECT_EQ(PictureSpread(Picture(8, 8, 0)), 0.0) << "no value anywhere";
}

TEST_F(PictureWatchTest, F05TheSamePictureAgainAndAgainIsFrozen) {
  const Picture picture = Scene(10.0);
  EXPECT_FALSE(Add(picture).is_frozen);
  EXPECT_FALSE(Add(picture).is_frozen);
  EXPECT_FALSE(Add(picture).is_frozen);
  EXPECT_TRUE(Add(picture).is_frozen) << "the third repeat: three times the native count of one";
  EXPECT_FALSE(Add(Scene(10.0)).is_frozen);
}

TEST_F(PictureWatchTest, F05IsFoundWithinHalfASecondAtNineFramesPerSecond) {
  // Three repeats at 9 Hz.
  const Picture picture = Scene(10.0);
  int frames = 1;
  while (!Add(picture).is_frozen) ++frames;
  EXPECT_LE((frames - 1) / 9.0, 0.5);
}

TEST_F(PictureWatchTest, F06NativeRepeatsAreNotFrozen) {
  options_.set_native_repeats(3);
  PictureWatch watch(options_);
  for (int i = 0; i < 50; ++i) {
    const Picture picture = Scene(10.0);
    for (int repeat = 0; repeat < 3; ++repeat) {
      now_ += std::chrono::milliseconds(37);
      EXPECT_FALSE(watch.Add(picture, now_, false).is_frozen);
    }
  }
}

TEST_F(PictureWatchTest, APictureThatIsSuddenlyUniformIsLikeAShutter) {
  for (int i = 0; i < 10; ++i) EXPECT_FALSE(Add(Scene(10.0)).is_like_shutter);
  for (int i = 0; i < 16; ++i) EXPECT_TRUE(Add(Scene(0.0)).is_like_shutter) << i;
  EXPECT_FALSE(Add(Scene(10.0)).is_like_shutter);
}

TEST_F(PictureWatchTest, ACameraThatTurnsToAWallSeesAScene) {
  // Half a second from a scene to a wall, as a hand turns it.
  for (int i = 0; i < 10; ++i) Add(Scene(10.0));
  for (int i = 0; i < 20; ++i)
    EXPECT_FALSE(Add(Scene(10.0 * (19 - i) / 20.0)).is_like_shutter) << i;
  for (int i = 0; i < 200; ++i) EXPECT_FALSE(Add(Scene(0.0)).is_like_shutter);
}

TEST_F(PictureWatchTest, WhatStaysUniformIsTheScene) {
  for (int i = 0; i < 10; ++i) Add(Scene(10.0));
  int taken_for_shutter = 0;
  for (int i = 0; i < 400; ++i) taken_for_shutter += Add(Scene(0.0)).is_like_shutter ? 1 : 0;
  EXPECT_NEAR(0.025 * taken_for_shutter, options_.max_duration_s(), 0.1);
}

TEST_F(PictureWatchTest, AColdUniformSceneCannotBeToldFromAShutterAndIsNot) {
  for (int i = 0; i < 10; ++i) Add(Scene(1.0));
  EXPECT_FALSE(Add(Scene(0.0)).is_like_shutter);
}

}  // namespace
}  // namespace isotherm
