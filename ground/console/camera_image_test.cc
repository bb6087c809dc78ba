#include "ground/console/camera_image.h"

#include <gtest/gtest.h>

#include <cstring>

#include "common/png/png.h"

namespace isotherm {
namespace {

TEST(CameraImageTest, DepthIsScaledToItsExtremesInMetres) {
  DepthFrame frame;
  frame.header.frame_number = 12;
  frame.depth_raw = Image<std::uint16_t>(8, 4);
  frame.depth_raw.Fill(700);
  frame.depth_raw.At(0, 0) = 500;
  frame.depth_raw.At(1, 0) = 900;
  frame.depth_raw.At(2, 0) = kNoDepth;
  frame.depth_raw.At(3, 0) = kNoDepthSaturated;
  const live::CameraImage image = ToCameraImage(frame, 8);
  EXPECT_EQ(image.sensor(), live::CameraImage::DEPTH);
  EXPECT_EQ(image.frame_number(), 12U);
  EXPECT_NEAR(image.min(), 0.5, 1e-6);
  EXPECT_NEAR(image.max(), 0.9, 1e-6);
  const auto* bytes = reinterpret_cast<const std::uint8_t*>(image.png().data());
  const auto head = ReadPngHead({bytes, image.png().size()});
  ASSERT_TRUE(head);
  EXPECT_EQ(head->width, 8U);
  EXPECT_EQ(head->height, 4U);
  EXPECT_EQ(head->channels, 1);
  EXPECT_EQ(head->bits, 8);
}

TEST(CameraImageTest, LargeImagesAreThinnedOut) {
  DepthFrame frame;
  frame.depth_raw = Image<std::uint16_t>(640, 480);
  frame.depth_raw.Fill(700);
  const live::CameraImage image = ToCameraImage(frame, 320);
  const auto* bytes = reinterpret_cast<const std::uint8_t*>(image.png().data());
  EXPECT_EQ(ReadPngHead({bytes, image.png().size()})->width, 320U);
}

TEST(CameraImageTest, AnImageWithoutAnyValueIsLeftOut) {
  ThermalFrame frame;
  frame.temperature_raw = Image<std::uint16_t>(8, 4);
  frame.temperature_raw.Fill(0);
  EXPECT_TRUE(ToCameraImage(frame, 8).png().empty());
  frame.temperature_raw = {};
  EXPECT_TRUE(ToCameraImage(frame, 8).png().empty());
}

TEST(CameraImageTest, ThermalIsInCelsiusAndSaysWhetherItCounts) {
  ThermalFrame frame;
  frame.valid = false;
  frame.temperature_raw = Image<std::uint16_t>(2, 1);
  frame.temperature_raw.At(0, 0) = 30315;  // Centi-kelvin: 30 °C.
  frame.temperature_raw.At(1, 0) = 32315;
  const live::CameraImage image = ToCameraImage(frame, 320);
  EXPECT_EQ(image.sensor(), live::CameraImage::THERMAL);
  EXPECT_NEAR(image.min(), 30.0, 1e-3);
  EXPECT_NEAR(image.max(), 50.0, 1e-3);
  EXPECT_FALSE(image.valid());
}

}  // namespace
}  // namespace isotherm
