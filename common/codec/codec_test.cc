#include "common/codec/codec.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <functional>
#include <random>
#include <string>

#include "common/codec/image_codecs.h"
#include "common/testing/guarded_buffer.h"

namespace isotherm {
namespace {

using Pixels = Image<std::uint16_t>;

/// Random tests print their seed; ISOTHERM_TEST_SEED repeats one.
std::uint32_t Seed() {
  const char* const text = std::getenv("ISOTHERM_TEST_SEED");
  const std::uint32_t seed = text != nullptr
                                 ? static_cast<std::uint32_t>(std::strtoul(text, nullptr, 10))
                                 : std::random_device{}();
  ::testing::Test::RecordProperty("seed", std::to_string(seed));
  std::printf("seed %u\n", seed);
  return seed;
}

Pixels Fill(int width, int height, const std::function<std::uint32_t(int, int)>& value) {
  Pixels image(width, height);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) image.At(x, y) = static_cast<std::uint16_t>(value(x, y));
  }
  return image;
}

/// A slope as a disparity camera sees it (few values) with holes.
Pixels DepthLike(int width, int height) {
  std::minstd_rand random(1);
  return Fill(width, height, [&random](int x, int y) {
    const auto disparity = static_cast<std::uint32_t>(600 - x / 3 + y / 5) + random() % 2;
    return random() % 10 == 0 ? 0 : 400'000 / disparity;
  });
}

/// A gradient with noise.
Pixels ThermalLike(int width, int height) {
  std::minstd_rand random(2);
  return Fill(width, height, [&random](int x, int y) {
    return 29'000 + static_cast<std::uint32_t>(10 * x + 3 * y) + random() % 16;
  });
}

struct NamedImage {
  const char* name;
  Pixels image;
};

std::vector<NamedImage> Images() {
  std::mt19937 random(3);
  const auto noise = [&random](int, int) { return static_cast<std::uint32_t>(random()); };
  std::vector<NamedImage> images;
  images.push_back({"OnePixel", Fill(1, 1, noise)});
  images.push_back({"OnePixelZero", Pixels(1, 1, 0)});
  images.push_back({"OneRow", Fill(640, 1, noise)});
  images.push_back({"OneColumn", Fill(1, 479, noise)});
  images.push_back({"TwoByTwo", Fill(2, 2, noise)});
  images.push_back({"AllZero", Pixels(640, 480, 0)});
  images.push_back({"AllSaturated", Pixels(640, 480, 65535)});
  images.push_back({"Constant", Pixels(33, 17, 1234)});
  images.push_back({"Noise", Fill(256, 192, noise)});
  images.push_back({"NoiseOddRows", Fill(61, 31, noise)});
  images.push_back(
      {"Extremes", Fill(64, 64, [&](int x, int y) { return noise(x, y) % 2 * 65535; })});
  images.push_back({"AllValues", Fill(256, 256, [](int x, int y) { return 256U * y + x; })});
  images.push_back({"FewBits", Fill(256, 192, [&](int x, int y) { return noise(x, y) % 3; })});
  images.push_back({"Depth", DepthLike(320, 240)});
  images.push_back({"Thermal", ThermalLike(382, 288)});
  Pixels saturated = DepthLike(320, 240);
  for (std::uint16_t& pixel : saturated.pixels()) pixel = pixel == 0 ? 65535 : pixel;
  images.push_back({"DepthWithSaturatedHoles", saturated});
  saturated.At(5, 5) = 0;
  images.push_back({"DepthWithBothHoles", saturated});
  return images;
}

EncodedImage EncodeWith(Encoding encoding, const Pixels& image) {
  return encoding == Encoding::kDepthStrips ? DepthEncoder().Encode(image)
                                            : ThermalEncoder().Encode(image, kCentikelvin);
}

class CodecTest : public ::testing::TestWithParam<Encoding> {};

TEST_P(CodecTest, EveryImageComesBackExactly) {
  for (const NamedImage& named : Images()) {
    const EncodedImage encoded = EncodeWith(GetParam(), named.image);
    EXPECT_EQ(encoded.encoding, GetParam());
    const Result<Pixels> decoded = Decode(encoded);
    ASSERT_TRUE(decoded) << named.name << ": " << decoded.error().message();
    EXPECT_EQ(*decoded, named.image) << named.name;
  }
}

TEST_P(CodecTest, RandomImagesComeBackExactly) {
  std::mt19937 random(Seed());
  for (int i = 0; i < 200; ++i) {
    const auto width = static_cast<int>(random() % 40 + 1);
    const auto height = static_cast<int>(random() % 40 + 1);
    const std::uint32_t range = 1U << (random() % 17);
    const auto base = static_cast<std::uint32_t>(random());
    const Pixels image = Fill(width, height, [&](int, int) {
      return random() % 4 == 0 ? 0 : base + static_cast<std::uint32_t>(random()) % range;
    });
    const Result<Pixels> decoded = Decode(EncodeWith(GetParam(), image));
    ASSERT_TRUE(decoded) << i;
    ASSERT_EQ(*decoded, image) << i;
  }
}

TEST_P(CodecTest, AnEncoderForgetsTheImageBefore) {
  DepthEncoder depth;
  ThermalEncoder thermal;
  for (const NamedImage& named : Images()) {
    const EncodedImage again = GetParam() == Encoding::kDepthStrips
                                   ? depth.Encode(named.image)
                                   : thermal.Encode(named.image, kCentikelvin);
    EXPECT_EQ(again.payload, EncodeWith(GetParam(), named.image).payload) << named.name;
  }
}

TEST_P(CodecTest, EveryTruncationIsAnError) {
  const EncodedImage whole = EncodeWith(GetParam(), DepthLike(40, 30));
  for (std::size_t size = 0; size < whole.payload.size(); ++size) {
    EncodedImage cut = whole;
    cut.payload.resize(size);
    const Result<Pixels> decoded = Decode(cut);
    ASSERT_FALSE(decoded) << size << " of " << whole.payload.size();
    ASSERT_EQ(decoded.error().code(), StatusCode::kDataLoss);
  }
  EncodedImage longer = whole;
  longer.payload.push_back(0);
  EXPECT_FALSE(Decode(longer));
}

TEST_P(CodecTest, AnotherSizeIsAnError) {
  EncodedImage encoded = EncodeWith(GetParam(), DepthLike(40, 30));
  std::swap(encoded.width, encoded.height);
  EXPECT_FALSE(Decode(encoded));
  encoded.width = 41;
  EXPECT_FALSE(Decode(encoded));
}

/// Decodes a payload behind which no memory can be read.
Status DecodeGuarded(Encoding encoding, const std::vector<std::uint8_t>& payload, Pixels& image) {
  const testing::GuardedBuffer guarded{std::span<const std::uint8_t>(payload)};
  if (encoding == Encoding::kDepthStrips) return codec::DepthCodec().Decode(guarded.bytes(), image);
  return codec::ThermalCodec().Decode(guarded.bytes(), image);
}

TEST_P(CodecTest, F65DamagedPayloadsAreRefusedAndNothingIsReadBeyondThem) {
  std::mt19937 random(Seed());
  const Pixels original = DepthLike(24, 18);
  const EncodedImage whole = EncodeWith(GetParam(), original);
  int refused = 0;
  constexpr int kTries = 20'000;
  for (int i = 0; i < kTries; ++i) {
    std::vector<std::uint8_t> damaged = whole.payload;
    for (auto flips = random() % 4 + 1; flips > 0; --flips) {
      damaged[random() % damaged.size()] = static_cast<std::uint8_t>(random());
    }
    Pixels image(24, 18);
    const Status status = DecodeGuarded(GetParam(), damaged, image);
    ASSERT_TRUE(status.ok() || status.code() == StatusCode::kDataLoss) << status.message();
    ASSERT_EQ(image.size(), original.size());
    if (damaged == whole.payload) {
      ASSERT_TRUE(status.ok() && image == original) << i;
    }
    refused += status.ok() ? 0 : 1;
  }
  // The rest are raw bits, whose every value is an image.
  EXPECT_GT(refused, kTries / 2);
}

TEST_P(CodecTest, F65GarbageIsRefused) {
  std::mt19937 random(Seed());
  int accepted = 0;
  for (int i = 0; i < 20'000; ++i) {
    std::vector<std::uint8_t> garbage(random() % 200);
    for (std::uint8_t& byte : garbage) byte = static_cast<std::uint8_t>(random() >> 9);
    Pixels image(24, 18);
    const Status status = DecodeGuarded(GetParam(), garbage, image);
    ASSERT_TRUE(status.ok() || status.code() == StatusCode::kDataLoss) << status.message();
    ASSERT_EQ(image.size(), 24U * 18U);
    accepted += status.ok() ? 1 : 0;
  }
  // A payload must end where its coder started from: 32 bits that chance does not give.
  EXPECT_EQ(accepted, 0);
}

INSTANTIATE_TEST_SUITE_P(Encodings, CodecTest,
                         ::testing::Values(Encoding::kDepthStrips, Encoding::kThermalStrips),
                         [](const auto& test) {
                           return test.param == Encoding::kDepthStrips ? "Depth" : "Thermal";
                         });

TEST(DecodeTest, ImpossibleSizesAreRefusedBeforeAllocating) {
  for (const auto& [width, height] : {std::pair{0, 5},
                                      {5, 0},
                                      {-1, 5},
                                      {5, -1},
                                      {-5, -5},
                                      {2'000'000'000, 2'000'000'000},
                                      {4097, 4096}}) {
    for (const Encoding encoding :
         {Encoding::kRaw16, Encoding::kPng16, Encoding::kDepthStrips, Encoding::kThermalStrips}) {
      const EncodedImage image{
          .encoding = encoding, .width = width, .height = height, .payload = {1, 2, 3}};
      const Result<Pixels> decoded = Decode(image);
      ASSERT_FALSE(decoded) << width << " x " << height;
      EXPECT_EQ(decoded.error().code(), StatusCode::kDataLoss);
    }
  }
}

TEST(DecodeTest, RawIsLittleEndianAndMustFit) {
  EncodedImage raw{.encoding = Encoding::kRaw16, .width = 2, .height = 1, .payload = {1, 2, 3, 4}};
  const Result<Pixels> decoded = Decode(raw);
  ASSERT_TRUE(decoded);
  EXPECT_EQ(decoded->At(0, 0), 0x0201);
  EXPECT_EQ(decoded->At(1, 0), 0x0403);
  raw.payload.pop_back();
  EXPECT_FALSE(Decode(raw));
}

/// 2 x 2 pixels 1, 256, 65535, 0, written by another program.
const std::vector<std::uint8_t> kPng = {
    0x89, 0x50, 0x4E, 0x47, 0x0D, 0x0A, 0x1A, 0x0A, 0x00, 0x00, 0x00, 0x0D, 0x49, 0x48, 0x44,
    0x52, 0x00, 0x00, 0x00, 0x02, 0x00, 0x00, 0x00, 0x02, 0x10, 0x00, 0x00, 0x00, 0x00, 0x07,
    0x4D, 0x8E, 0xBB, 0x00, 0x00, 0x00, 0x12, 0x49, 0x44, 0x41, 0x54, 0x78, 0x9C, 0x63, 0x60,
    0x60, 0x64, 0x64, 0x60, 0xF8, 0xFF, 0x9F, 0x81, 0x01, 0x00, 0x07, 0x12, 0x02, 0x01, 0xDE,
    0xF8, 0x13, 0xAE, 0x00, 0x00, 0x00, 0x00, 0x49, 0x45, 0x4E, 0x44, 0xAE, 0x42, 0x60, 0x82};

TEST(DecodeTest, PngFromOtherProgramsIsRead) {
  EncodedImage png{.encoding = Encoding::kPng16, .width = 2, .height = 2, .payload = kPng};
  const Result<Pixels> decoded = Decode(png);
  ASSERT_TRUE(decoded) << decoded.error().message();
  EXPECT_THAT(decoded->pixels(), ::testing::ElementsAre(1, 256, 65535, 0));
  png.width = 1;
  EXPECT_FALSE(Decode(png));
  png.width = 2;
  for (std::size_t size = 0; size < kPng.size(); ++size) {
    png.payload.assign(kPng.begin(), kPng.begin() + static_cast<std::ptrdiff_t>(size));
    EXPECT_FALSE(Decode(png)) << size;
  }
}

TEST(DecodeTest, CountsAreUnpackedButAreNoTemperatures) {
  Image<std::uint16_t> counts(3, 2);
  for (std::size_t i = 0; i < counts.size(); ++i) {
    counts.data()[i] = static_cast<std::uint16_t>(1'000 + 11'111 * i);
  }
  EncodedImage packed = PackCounts(counts);
  EXPECT_EQ(packed.encoding, Encoding::kCounts16);
  EXPECT_EQ(*Decode(packed), counts);
  ASSERT_TRUE(DecodeTemperatures(packed).has_value());
  EXPECT_TRUE(DecodeTemperatures(packed)->empty());
  EXPECT_EQ(*DecodeTemperatures(ThermalEncoder().Encode(counts, kCentikelvin)), counts);
  while (!packed.payload.empty()) {
    packed.payload.pop_back();
    EXPECT_FALSE(DecodeTemperatures(packed).has_value()) << packed.payload.size();
  }
}

TEST(DecodeTest, AnotherScaleThanCentikelvinHasAnEncodingOfItsOwn) {
  Image<std::uint16_t> raw(3, 2, 56'157);
  EXPECT_EQ(ThermalEncoder().Encode(raw, kCentikelvin).encoding, Encoding::kThermalStrips);
  EXPECT_EQ(ThermalEncoder().Encode(raw, RadiometricScale{0.01, 0.0}).encoding,
            Encoding::kThermalStrips);
  for (const RadiometricScale& scale :
       {RadiometricScale{0.02, 0.0}, RadiometricScale{0.01, 100.0}}) {
    const EncodedImage encoded = ThermalEncoder().Encode(raw, scale);
    EXPECT_EQ(encoded.encoding, Encoding::kScaledThermalStrips);
    EXPECT_EQ(*DecodeTemperatures(encoded), raw);
  }
  EncodedImage plain = PackCounts(raw);
  plain.encoding = Encoding::kScaledRaw16;
  EXPECT_EQ(*DecodeTemperatures(plain), raw);
  plain.payload.pop_back();
  EXPECT_FALSE(DecodeTemperatures(plain).has_value());
}

TEST(DecodeTest, AnUnknownEncodingIsRefused) {
  const EncodedImage image{
      .encoding = static_cast<Encoding>(200), .width = 2, .height = 2, .payload = {1, 2, 3}};
  const Result<Pixels> decoded = Decode(image);
  ASSERT_FALSE(decoded);
  EXPECT_THAT(decoded.error().message(), ::testing::HasSubstr("200"));
}

}  // namespace
}  // namespace isotherm
