#include "ground/radiometric_calibration/aperture_image.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace isotherm {
namespace {

using ::testing::HasSubstr;

constexpr int kWidth = 160, kHeight = 120;
constexpr double kX = 70.0, kY = 55.0;

/// A disc before a plate, its rim blurred over some pixels.
Image<float> Disc(double radius, double disc_celsius, double plate_celsius) {
  Image<float> image(kWidth, kHeight);
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x) {
      const double inside = 1.0 / (1.0 + std::exp(std::hypot(x - kX, y - kY) - radius));
      image.At(x, y) = static_cast<float>(plate_celsius + inside * (disc_celsius - plate_celsius));
    }
  return image;
}

double FromMiddle(std::uint32_t pixel) {
  const std::uint32_t row = pixel / kWidth, column = pixel % kWidth;
  return std::hypot(column - kX, row - kY);
}

double FarthestFromMiddle(const std::vector<PixelPatch>& patches) {
  double farthest = 0.0;
  for (const PixelPatch& patch : patches)
    for (const std::uint32_t pixel : patch) farthest = std::max(farthest, FromMiddle(pixel));
  return farthest;
}

double NearestToMiddle(const std::vector<PixelPatch>& patches) {
  double nearest = 1e9;
  for (const PixelPatch& patch : patches)
    for (const std::uint32_t pixel : patch) nearest = std::min(nearest, FromMiddle(pixel));
  return nearest;
}

TEST(ApertureImageTest, HoleAndPlateAreFoundAwayFromTheRim) {
  for (const double radius : {12.0, 25.0, 45.0}) {
    const Result<ApertureImage> found = FindAperture(Disc(radius, 120.0, 24.0), 120.0);
    ASSERT_TRUE(found) << found.error().message();
    EXPECT_NEAR(found->hole_radius_px, radius, 0.3);
    EXPECT_LE(FarthestFromMiddle(found->body), radius - kRimMargin_px + 1.0);
    EXPECT_GE(NearestToMiddle(found->plate), radius + kRimMargin_px - 1.0);
    EXPECT_NEAR(MeanOf(found->body, found->celsius), 120.0, 0.2);
    EXPECT_NEAR(MeanOf(found->plate, found->celsius), 24.0, 0.2);
    std::size_t pixels = 0;
    for (const PixelPatch& patch : found->plate) pixels += patch.size();
    EXPECT_GT(static_cast<double>(pixels), 0.4 * kWidth * kHeight) << radius;
  }
}

TEST(ApertureImageTest, ABlackBodyMayBeColderThanThePlate) {
  const Result<ApertureImage> found = FindAperture(Disc(25.0, 1.0, 24.0), 0.0);
  ASSERT_TRUE(found) << found.error().message();
  EXPECT_NEAR(MeanOf(found->body, found->celsius), 1.0, 0.1);
}

TEST(ApertureImageTest, ABlackBodyMayFillTheImage) {
  const Result<ApertureImage> found = FindAperture(Disc(500.0, 120.0, 24.0), 120.0);
  ASSERT_TRUE(found) << found.error().message();
  EXPECT_TRUE(found->fills_image());
  EXPECT_NEAR(MeanOf(found->body, found->celsius), 120.0, 1e-3);
}

TEST(ApertureImageTest, DeadPixelsAreLeftOut) {
  Image<float> image = Disc(25.0, 120.0, 24.0);
  for (const auto& [x, y] : {std::pair(70, 55), std::pair(10, 10), std::pair(71, 60)})
    image.At(x, y) = std::numeric_limits<float>::quiet_NaN();
  const Result<ApertureImage> found = FindAperture(std::move(image), 120.0);
  ASSERT_TRUE(found) << found.error().message();
  EXPECT_NEAR(MeanOf(found->body, found->celsius), 120.0, 0.2);
  EXPECT_NEAR(MeanOf(found->plate, found->celsius), 24.0, 0.2);
}

TEST(ApertureImageTest, WhatIsNoHoleIsRefused) {
  const auto message = [](Image<float> image) {
    const Result<ApertureImage> found = FindAperture(std::move(image), 120.0);
    return found ? std::string() : found.error().message();
  };
  EXPECT_THAT(message(Disc(7.0, 120.0, 24.0)), HasSubstr("too few pixels"));
  Image<float> two = Disc(20.0, 120.0, 24.0);
  for (int y = 100; y < 110; ++y)
    for (int x = 130; x < 150; ++x) two.At(x, y) = 110.0F;
  EXPECT_THAT(message(std::move(two)), HasSubstr("nothing but the plate with one hole"));
  Image<float> too_hot = Disc(20.0, 120.0, 24.0);
  for (float& value : too_hot.pixels())
    if (value > 100.0F) value = std::numeric_limits<float>::quiet_NaN();
  EXPECT_THAT(message(std::move(too_hot)), HasSubstr("within the camera's range"));
  EXPECT_THAT(message(Image<float>(kWidth, kHeight, std::numeric_limits<float>::quiet_NaN())),
              HasSubstr("have no value"));
}

}  // namespace
}  // namespace isotherm
