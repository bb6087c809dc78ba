#include "common/png/png.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <png.h>
#include <sys/resource.h>
#include <zlib.h>

#include <array>
#include <ctime>
#include <functional>
#include <random>
#include <string_view>

#include "common/testing/guarded_buffer.h"

namespace isotherm {
namespace {

using ::testing::HasSubstr;
using Grey = Image<std::uint16_t>;
using Bytes = std::vector<std::uint8_t>;

Grey Noise(int width, int height) {
  Grey image(width, height);
  std::mt19937 random(7);
  for (std::uint16_t& pixel : image.pixels()) pixel = static_cast<std::uint16_t>(random());
  return image;
}

void AppendNumber(std::uint32_t value, Bytes& out) {
  for (int shift = 24; shift >= 0; shift -= 8)
    out.push_back(static_cast<std::uint8_t>(value >> shift));
}

/// One chunk with its right checksum, written without libpng.
void AppendChunk(std::string_view name, const Bytes& content, Bytes& out) {
  AppendNumber(static_cast<std::uint32_t>(content.size()), out);
  const std::size_t begin = out.size();
  out.insert(out.end(), name.begin(), name.end());
  out.insert(out.end(), content.begin(), content.end());
  AppendNumber(static_cast<std::uint32_t>(
                   crc32(0, out.data() + begin, static_cast<uInt>(out.size() - begin))),
               out);
}

Bytes Deflated(const Bytes& plain) {
  uLongf size = compressBound(plain.size());
  Bytes packed(size);
  compress2(packed.data(), &size, plain.data(), plain.size(), 9);
  packed.resize(size);
  return packed;
}

/// A file of one kind: bits, colour type and interlace method as in its head.
Bytes Png(std::uint32_t width, std::uint32_t height, std::array<std::uint8_t, 3> kind,
          const Bytes& packed, const std::function<void(Bytes&)>& before_pixels = {}) {
  Bytes file = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1A, '\n'};
  Bytes head;
  AppendNumber(width, head);
  AppendNumber(height, head);
  head.insert(head.end(), {kind[0], kind[1], 0, 0, kind[2]});
  AppendChunk("IHDR", head, file);
  if (before_pixels) before_pixels(file);
  AppendChunk("IDAT", packed, file);
  AppendChunk("IEND", {}, file);
  return file;
}

constexpr std::array<std::uint8_t, 3> kGrey16 = {16, 0, 0};

/// Rows of 16-bit grey without filter, as the specification lays them out.
Bytes Rows(const Grey& image) {
  Bytes rows;
  for (int y = 0; y < image.height(); ++y) {
    rows.push_back(0);
    for (const std::uint16_t pixel : image.Row(y)) {
      rows.push_back(static_cast<std::uint8_t>(pixel >> 8));
      rows.push_back(static_cast<std::uint8_t>(pixel));
    }
  }
  return rows;
}

/// The most that this process has had so far.
long PeakMemory_kb() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return usage.ru_maxrss;
}

Status Decode(const Bytes& file, int width, int height) {
  Grey image(width, height);
  return DecodeGrey16Png(file, image);
}

TEST(PngTest, WhatIsEncodedComesBackExactly) {
  for (const auto& [width, height] : {std::pair{1, 1}, {3, 5}, {640, 480}}) {
    const Grey image = Noise(width, height);
    const auto file = EncodeGrey16Png(image);
    ASSERT_TRUE(file);
    const auto head = ReadPngHead(*file);
    ASSERT_TRUE(head);
    EXPECT_EQ(head->bits, 16);
    EXPECT_EQ(head->channels, 1);
    Grey decoded(width, height);
    ASSERT_TRUE(DecodeGrey16Png(*file, decoded).ok());
    EXPECT_EQ(decoded, image);
  }
}

TEST(PngTest, FilesOfOtherWritersAreRead) {
  const Grey image = Noise(9, 4);
  Grey decoded(9, 4);
  ASSERT_TRUE(DecodeGrey16Png(Png(9, 4, kGrey16, Deflated(Rows(image))), decoded).ok());
  EXPECT_EQ(decoded, image);
}

TEST(PngTest, ColoursKeepTheirOrder) {
  const Bytes rgb = {255, 0, 0, 0, 128, 0, 0, 0, 7, 1, 2, 3};
  const auto file = EncodePng({.width = 2, .height = 2, .channels = 3, .bits = 8, .bytes = rgb});
  ASSERT_TRUE(file);
  png_image reader{};  // libpng's other interface, which shares no code of ours.
  reader.version = PNG_IMAGE_VERSION;
  ASSERT_TRUE(png_image_begin_read_from_memory(&reader, file->data(), file->size()));
  reader.format = PNG_FORMAT_RGB;
  Bytes read(PNG_IMAGE_SIZE(reader));
  ASSERT_TRUE(png_image_finish_read(&reader, nullptr, read.data(), 0, nullptr));
  EXPECT_EQ(read, rgb);
}

TEST(PngTest, AnotherSizeOrKindIsRefused) {
  const Bytes packed = Deflated(Rows(Noise(9, 4)));
  EXPECT_FALSE(Decode(Png(9, 4, kGrey16, packed), 4, 9).ok());
  EXPECT_FALSE(Decode(Png(9, 4, {8, 0, 0}, packed), 9, 4).ok());
  EXPECT_FALSE(Decode(Png(9, 4, {16, 2, 0}, packed), 9, 4).ok());
  EXPECT_FALSE(Decode(Png(9, 4, {16, 0, 7}, packed), 9, 4).ok());
  EXPECT_THAT(Decode(Bytes(100, 'x'), 9, 4).message(), HasSubstr("not a PNG"));
  EXPECT_THAT(EncodeGrey16Png(Grey()).error().message(), HasSubstr("without pixels"));
}

TEST(PngTest, F65FileTooSmallForItsImageIsRefusedBeforeDecoding) {
  const Status status = Decode(Png(4096, 4096, kGrey16, Deflated(Bytes(100))), 4096, 4096);
  EXPECT_THAT(status.message(), HasSubstr("bytes cannot hold 4096 x 4096"));
}

TEST(PngTest, F65PixelsBeyondTheImageAndOtherChunksAreNotUnpacked) {
  const Grey image = Noise(9, 4);
  Bytes rows = Rows(image);
  rows.resize(rows.size() + (64U << 20));  // 64 MB of zeros more than the image has.
  const Bytes bomb = Deflated(Bytes(64U << 20));
  const auto with_texts = [&bomb](Bytes& file) {
    Bytes text = {'k', 0, 0};  // Keyword, its end, method.
    text.insert(text.end(), bomb.begin(), bomb.end());
    for (int i = 0; i < 100; ++i) AppendChunk("zTXt", text, file);
    AppendChunk("iCCP", text, file);
  };
  Grey decoded(9, 4);
  const std::clock_t before = std::clock();
  ASSERT_TRUE(DecodeGrey16Png(Png(9, 4, kGrey16, Deflated(Rows(image)), with_texts), decoded).ok());
  EXPECT_EQ(decoded, image);
  static_cast<void>(DecodeGrey16Png(Png(9, 4, kGrey16, Deflated(rows)), decoded));
  // 100 texts of 64 MB take half a minute to unpack.
  EXPECT_LT(std::clock() - before, 5 * CLOCKS_PER_SEC);
}

TEST(PngTest, F65NoTextOfAFileIsKept) {
  // Each text is small enough for libpng, which would keep all of them: 800 MB.
  const Bytes packed = Deflated(Bytes(4U << 20, 'x'));
  const auto with_texts = [&packed](Bytes& file) {
    Bytes text = {'k', 0, 0};
    text.insert(text.end(), packed.begin(), packed.end());
    for (int i = 0; i < 200; ++i) AppendChunk("zTXt", text, file);
  };
  const Grey image = Noise(9, 4);
  const Bytes file = Png(9, 4, kGrey16, Deflated(Rows(image)), with_texts);
  Grey decoded(9, 4);
  const long before_kb = PeakMemory_kb();
  ASSERT_TRUE(DecodeGrey16Png(file, decoded).ok());
  EXPECT_EQ(decoded, image);
  EXPECT_LT(PeakMemory_kb() - before_kb, 50'000);
}

TEST(PngTest, F65EveryTruncationIsAnErrorAndNothingIsReadBeyondTheEnd) {
  const Bytes whole = *EncodeGrey16Png(Noise(16, 12));
  for (std::size_t size = 0; size < whole.size(); ++size) {
    const testing::GuardedBuffer cut(std::span<const std::uint8_t>(whole.data(), size));
    Grey image(16, 12);
    ASSERT_EQ(DecodeGrey16Png(cut.bytes(), image).code(), StatusCode::kDataLoss) << size;
  }
}

TEST(PngTest, F65EveryFlippedBitIsAnErrorOrHarmless) {
  const Grey image = Noise(16, 12);
  const Bytes whole = *EncodeGrey16Png(image);
  int refused = 0;
  for (std::size_t bit = 0; bit < 8 * whole.size(); ++bit) {
    Bytes damaged = whole;
    damaged[bit / 8] ^= static_cast<std::uint8_t>(1U << bit % 8);
    const testing::GuardedBuffer file(damaged);
    Grey decoded(16, 12);
    const Status status = DecodeGrey16Png(file.bytes(), decoded);
    refused += status.ok() ? 0 : 1;
    ASSERT_TRUE(!status.ok() || decoded == image) << "bit " << bit;
  }
  EXPECT_GT(refused, static_cast<int>(8 * whole.size() - 200)) << "all but the last checksum";
}

}  // namespace
}  // namespace isotherm
