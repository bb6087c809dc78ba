#include "common/doubts/repeat_detector.h"

#include <gtest/gtest.h>

#include <random>

namespace isotherm {
namespace {

constexpr unsigned kSeed = 7;

Image<std::uint16_t> NoiseImage(int width, int height) {
  std::mt19937 random(kSeed);
  Image<std::uint16_t> image(width, height);
  for (std::uint16_t& pixel : image.pixels()) pixel = static_cast<std::uint16_t>(random());
  return image;
}

TEST(RepeatDetectorTest, TheFirstImageIsNewAndItsRepeatsAreCounted) {
  const Image<std::uint16_t> image = NoiseImage(33, 7);
  RepeatDetector detector;
  EXPECT_EQ(detector.Add(image), 0);
  EXPECT_EQ(detector.Add(image), 1);
  EXPECT_EQ(detector.Add(image), 2);
}

// Each pixel counts, also those behind the last whole word.
TEST(RepeatDetectorTest, AnImageThatDiffersInOneBitIsNew) {
  Image<std::uint16_t> image = NoiseImage(33, 7);
  RepeatDetector detector;
  detector.Add(image);
  for (std::uint16_t& pixel : image.pixels()) {
    pixel ^= 1U;
    EXPECT_EQ(detector.Add(image), 0);
    EXPECT_EQ(detector.Add(image), 1);
  }
}

TEST(RepeatDetectorTest, OnlyTheImageRightBeforeCounts) {
  const Image<std::uint16_t> image = NoiseImage(8, 8);
  RepeatDetector detector;
  detector.Add(image);
  EXPECT_EQ(detector.Add(Image<std::uint16_t>(8, 8, 5)), 0);
  EXPECT_EQ(detector.Add(image), 0);
}

TEST(RepeatDetectorTest, TheSamePixelsInOtherRowsAreAnotherImage) {
  RepeatDetector detector;
  detector.Add(Image<std::uint16_t>(8, 4, 5));
  EXPECT_EQ(detector.Add(Image<std::uint16_t>(4, 8, 5)), 0);
}

TEST(RepeatDetectorTest, AnEmptyImageBeforeAnyOtherIsNew) {
  RepeatDetector detector;
  EXPECT_EQ(detector.Add(Image<std::uint16_t>()), 0);
}

}  // namespace
}  // namespace isotherm
