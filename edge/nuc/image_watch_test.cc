#include "edge/nuc/image_watch.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "common/testing/test_seed.h"
#include "edge/options/edge_options.pb.h"

namespace isotherm {
namespace {

using ThermalImage = Image<std::uint16_t>;

constexpr double kNoise_k = 0.05;

class ImageWatchTest : public ::testing::Test {
 protected:
  /// A ramp from 293 K with noise.
  ThermalImage Scene(double range_k) {
    std::normal_distribution<double> noise(0.0, 100.0 * kNoise_k);
    ThermalImage image(96, 72);
    for (int y = 0; y < image.height(); ++y) {
      for (int x = 0; x < image.width(); ++x) {
        image.At(x, y) = static_cast<std::uint16_t>(29'300.0 + 100.0 * range_k * x / image.width() +
                                                    noise(random_) + 0.5);
      }
    }
    return image;
  }
  ImageEvidence Add(const ThermalImage& image, bool known_closed = false) {
    now_ += std::chrono::milliseconds(25);
    return watch_.Add(image, kCentikelvin, now_, known_closed);
  }

  std::mt19937 random_{testing::Seed()};
  NucOptions options_;
  ImageWatch watch_{options_};
  CaptureTime now_{std::chrono::hours(1)};
};

TEST_F(ImageWatchTest, SpreadIsTheStandardDeviationInKelvin) {
  // Of a ramp over 12 K: 12 / sqrt(12). The noise adds nothing that shows.
  EXPECT_NEAR(ImageSpread(Scene(12.0), kCentikelvin), 12.0 / std::sqrt(12.0), 0.1);
  EXPECT_EQ(ImageSpread(ThermalImage(8, 8, 0), kCentikelvin), 0.0) << "no value anywhere";
}

TEST_F(ImageWatchTest, F05TheSameImageAgainAndAgainIsFrozen) {
  const ThermalImage image = Scene(10.0);
  EXPECT_FALSE(Add(image).is_frozen);
  EXPECT_FALSE(Add(image).is_frozen);
  EXPECT_FALSE(Add(image).is_frozen);
  EXPECT_TRUE(Add(image).is_frozen) << "the third repeat: three times the native count of one";
  EXPECT_FALSE(Add(Scene(10.0)).is_frozen);
}

TEST_F(ImageWatchTest, F05IsFoundWithinHalfASecondAtNineFramesPerSecond) {
  // Three repeats at 9 Hz.
  const ThermalImage image = Scene(10.0);
  int frames = 1;
  while (!Add(image).is_frozen) ++frames;
  EXPECT_LE((frames - 1) / 9.0, 0.5);
}

TEST_F(ImageWatchTest, F06NativeRepeatsAreNotFrozen) {
  options_.mutable_expert()->set_native_repeats(3);
  ImageWatch watch(options_);
  for (int i = 0; i < 50; ++i) {
    const ThermalImage image = Scene(10.0);
    for (int repeat = 0; repeat < 3; ++repeat) {
      now_ += std::chrono::milliseconds(37);
      EXPECT_FALSE(watch.Add(image, kCentikelvin, now_, false).is_frozen);
    }
  }
}

TEST_F(ImageWatchTest, AnImageThatIsSuddenlyUniformIsLikeAShutter) {
  for (int i = 0; i < 10; ++i) EXPECT_FALSE(Add(Scene(10.0)).is_like_shutter);
  for (int i = 0; i < 16; ++i) EXPECT_TRUE(Add(Scene(0.0)).is_like_shutter) << i;
  EXPECT_FALSE(Add(Scene(10.0)).is_like_shutter);
}

TEST_F(ImageWatchTest, ACameraThatTurnsToAWallSeesAScene) {
  // Half a second from a scene to a wall, as a hand turns it.
  for (int i = 0; i < 10; ++i) Add(Scene(10.0));
  for (int i = 0; i < 20; ++i)
    EXPECT_FALSE(Add(Scene(10.0 * (19 - i) / 20.0)).is_like_shutter) << i;
  for (int i = 0; i < 200; ++i) EXPECT_FALSE(Add(Scene(0.0)).is_like_shutter);
}

TEST_F(ImageWatchTest, WhatStaysUniformIsTheScene) {
  for (int i = 0; i < 10; ++i) Add(Scene(10.0));
  int taken_for_shutter = 0;
  for (int i = 0; i < 400; ++i) taken_for_shutter += Add(Scene(0.0)).is_like_shutter ? 1 : 0;
  EXPECT_NEAR(0.025 * taken_for_shutter, options_.expert().max_duration_s(), 0.1);
}

TEST_F(ImageWatchTest, AColdUniformSceneCannotBeToldFromAShutterAndIsNot) {
  for (int i = 0; i < 10; ++i) Add(Scene(1.0));
  EXPECT_FALSE(Add(Scene(0.0)).is_like_shutter);
}

}  // namespace
}  // namespace isotherm
