#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "common/codec/byte_io.h"
#include "common/codec/prediction.h"
#include "common/codec/reference/strip_reference.h"
#include "common/codec/strip_decoder.h"
#include "common/codec/strip_encoder.h"
#include "common/codec/strip_layout.h"
#include "common/testing/kernel_checks.h"

namespace isotherm::codec {
namespace {

using Pixels = Image<std::uint16_t>;

/// A slope with holes and steps, whose noise is up to `noise`: tokens of all kinds, and in a large
/// image all contexts.
Pixels Slope(int width, int height, int noise, testing::Random& random) {
  Pixels image(width, height);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const int step = x / 7 % 3 == 0 ? 900 : 0;
      const int value = 20'000 + 3 * x - 5 * y + step + random.Integer(-noise, noise);
      image.At(x, y) = static_cast<std::uint16_t>(random.Chance(0.1) ? 0 : value);
    }
  }
  return image;
}

std::vector<Pixels> SomeImages(testing::Random& random) {
  std::vector<Pixels> images;
  for (const int height : {1, 2, 15, 16, 17, 31, 33, 64, 100})
    images.push_back(Slope(random.Integer(1, 70), height, 1 << random.Integer(0, 14), random));
  images.push_back(Pixels(5, 40, 0));
  images.push_back(Pixels(40, 5, 65'535));
  return images;
}

template <typename Model>
std::vector<std::uint8_t> Pack(const Pixels& image) {
  std::vector<std::uint8_t> payload;
  StripEncoder<Model>().Encode(image, nullptr, payload);
  return payload;
}

template <typename Model>
std::optional<Pixels> Unpack(const std::vector<std::uint8_t>& payload, int width, int height) {
  Pixels image(width, height);
  PayloadReader in(payload);
  if (!StripDecoder<Model>().Decode(in, nullptr, image)) return std::nullopt;
  return image;
}

template <typename Model>
class StripCoderTest : public ::testing::Test {};
using Models = ::testing::Types<DepthModel, ThermalModel>;
TYPED_TEST_SUITE(StripCoderTest, Models);

TYPED_TEST(StripCoderTest, PacksWithEveryInstructionSetAsTheReferenceDoes) {
  testing::Random random;
  for (const Pixels& image : SomeImages(random)) {
    const std::vector<std::uint8_t> expected = reference::Encode<TypeParam>(image);
    testing::ForEachInstructionSet(
        [&] { EXPECT_EQ(Pack<TypeParam>(image), expected) << image.width() << image.height(); });
  }
}

TYPED_TEST(StripCoderTest, UnpacksWithEveryInstructionSetWhatTheReferencePacks) {
  testing::Random random;
  for (const Pixels& image : SomeImages(random)) {
    const std::vector<std::uint8_t> payload = reference::Encode<TypeParam>(image);
    testing::ForEachInstructionSet(
        [&] { EXPECT_EQ(Unpack<TypeParam>(payload, image.width(), image.height()), image); });
  }
}

TYPED_TEST(StripCoderTest, WhatIsDamagedOfOneStripSpoilsNoOther) {
  testing::Random random;
  const Pixels image = Slope(40, 64, 30, random);
  std::vector<std::uint8_t> payload = Pack<TypeParam>(image);
  payload[payload.size() - 100] ^= 0x55;  // The middle of the last strip.
  Pixels unpacked(image.width(), image.height());
  PayloadReader in(payload);
  StripDecoder<TypeParam>().Decode(in, nullptr, unpacked);
  EXPECT_NE(unpacked, image);
  const int rows = StripRows(image.height());
  for (int y = 0; y < image.height() - rows; ++y) {
    for (int x = 0; x < image.width(); ++x) ASSERT_EQ(unpacked.At(x, y), image.At(x, y)) << y;
  }
}

TYPED_TEST(StripCoderTest, TellsTheLargestThatWasPacked) {
  Pixels image(20, 40, 3);
  image.At(7, 39) = 4'711;
  const std::vector<std::uint8_t> payload = Pack<TypeParam>(image);
  Pixels unpacked(20, 40);
  PayloadReader in(payload);
  EXPECT_EQ(StripDecoder<TypeParam>().Decode(in, nullptr, unpacked), 4'711);
}

TEST(StripLayoutTest, StripsAreOfEqualHeightButForTheLast) {
  for (int height = 1; height < 200; ++height) {
    std::array<int, kStrips> rows{};
    for (int row = 0; row < StripRows(height); ++row) {
      for (int strip = 0; strip < StripsWithRow(height, row); ++strip)
        ++rows[static_cast<std::size_t>(strip)];
    }
    int sum = 0;
    for (int strip = 0; strip < kStrips; ++strip) {
      const reference::Strip expected = reference::StripOf(height, strip);
      EXPECT_EQ(rows[static_cast<std::size_t>(strip)], expected.end_row - expected.first_row);
      sum += rows[static_cast<std::size_t>(strip)];
    }
    EXPECT_EQ(sum, height);
  }
}

}  // namespace
}  // namespace isotherm::codec
