#include "common/codec/halves_decoders.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "common/codec/codec.h"
#include "common/png/png.h"
#include "common/testing/guarded_buffer.h"
#include "common/testing/kernel_checks.h"

namespace isotherm {
namespace {

using Bytes = std::vector<std::uint8_t>;
using Pixels = Image<std::uint16_t>;

Bytes Load(const std::string& name) {
  std::ifstream file(std::filesystem::path(ISOTHERM_SOURCE_DIR "/tests/data") / name,
                     std::ios::binary);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

Pixels LoadPng(const std::string& name) {
  const Bytes bytes = Load(name);
  const Result<PngHead> head = ReadPngHead(bytes);
  if (!head) return {};
  Pixels image(static_cast<int>(head->width), static_cast<int>(head->height));
  EXPECT_TRUE(DecodeGrey16Png(bytes, image).ok());
  return image;
}

/// An image that version 0.2.0 packed, and the image.
struct Packed {
  const char* name;
  Encoding encoding;
  const char* payload;
  const char* image;
};

class HalvesDecodersTest : public ::testing::TestWithParam<Packed> {
 protected:
  const Pixels expected_ = LoadPng(GetParam().image);
  EncodedImage packed_{.encoding = GetParam().encoding,
                       .width = expected_.width(),
                       .height = expected_.height(),
                       .payload = Load(GetParam().payload)};
};

TEST_P(HalvesDecodersTest, ReadWhatVersion02Packed) {
  ASSERT_FALSE(packed_.payload.empty());
  const Result<Pixels> image = Decode(packed_);
  ASSERT_TRUE(image) << image.error().message();
  EXPECT_EQ(*image, expected_);
}

TEST_P(HalvesDecodersTest, F65DamagedPayloadsAreRefusedAndNothingIsReadBeyondThem) {
  testing::Random random;
  const auto decode = [this](const Bytes& payload) {
    const testing::GuardedBuffer guarded{std::span<const std::uint8_t>(payload)};
    Pixels image(expected_.width(), expected_.height());
    const Status status = packed_.encoding == Encoding::kDepthRans
                              ? codec::DepthHalvesDecoder().Decode(guarded.bytes(), image)
                              : codec::ThermalHalvesDecoder().Decode(guarded.bytes(), image);
    EXPECT_TRUE(status.ok() || status.code() == StatusCode::kDataLoss) << status.message();
    return status.ok();
  };
  ASSERT_TRUE(decode(packed_.payload));
  int refused = 0;
  constexpr int kTries = 100;
  for (int i = 0; i < kTries; ++i) {
    Bytes damaged = packed_.payload;
    for (int flips = random.Integer(1, 4); flips > 0; --flips) {
      const auto last = static_cast<int>(damaged.size()) - 1;
      damaged[static_cast<std::size_t>(random.Integer(0, last))] ^=
          static_cast<std::uint8_t>(random.Integer(1, 255));
    }
    refused += decode(damaged) ? 0 : 1;
    damaged.resize(
        static_cast<std::size_t>(random.Integer(0, static_cast<int>(packed_.payload.size()) - 1)));
    EXPECT_FALSE(decode(damaged));
  }
  // The rest are raw bits, whose every value is an image.
  EXPECT_GT(refused, kTries / 2);
}

INSTANTIATE_TEST_SUITE_P(
    Images, HalvesDecodersTest,
    ::testing::Values(Packed{"Depth", Encoding::kDepthRans, "halves/depth_000072.bin",
                             "furnace_excerpt/depth/000072.png"},
                      Packed{"Thermal", Encoding::kThermalRans, "halves/thermal_000096.bin",
                             "furnace_excerpt/thermal/000096.png"},
                      Packed{"ScaledThermal", Encoding::kScaledThermalRans,
                             "halves/thermal_000096.bin", "furnace_excerpt/thermal/000096.png"}),
    [](const auto& test) { return std::string(test.param.name); });

}  // namespace
}  // namespace isotherm
