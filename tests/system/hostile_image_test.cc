// Small images that ask for much: what `isotherm import` takes to refuse or read them, measured
// from outside.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <zlib.h>

#include <cstring>
#include <string>
#include <string_view>
#include <vector>

#include "common/dataset/testing/dataset_folder.h"
#include "tests/system/measured_run.h"

namespace isotherm::system_test {
namespace {

using ::testing::HasSubstr;
using Bytes = std::vector<std::uint8_t>;

/// Where the head of a PNG ends: 8 bytes of mark and a chunk of 13.
constexpr std::size_t kHeadEnd = 8 + 12 + 13;

void AppendNumber(std::uint32_t number, Bytes& bytes) {
  for (int shift = 24; shift >= 0; shift -= 8)
    bytes.push_back(static_cast<std::uint8_t>(number >> shift));
}

Bytes Chunk(std::string_view kind, const Bytes& data) {
  Bytes chunk;
  AppendNumber(static_cast<std::uint32_t>(data.size()), chunk);
  chunk.insert(chunk.end(), kind.begin(), kind.end());
  chunk.insert(chunk.end(), data.begin(), data.end());
  AppendNumber(
      static_cast<std::uint32_t>(crc32(0, chunk.data() + 4, static_cast<uInt>(chunk.size() - 4))),
      chunk);
  return chunk;
}

/// Zeros, packed: about a thousandth of `size`. They are made a part at a time, because the kernel
/// counts what this process holds in the peak of those that it starts.
Bytes PackedZeros(std::size_t size) {
  Bytes zeros(1'000'000);
  Bytes packed(size / 500 + 1000);
  z_stream stream{};
  EXPECT_EQ(deflateInit(&stream, Z_BEST_COMPRESSION), Z_OK);
  stream.next_out = packed.data();
  stream.avail_out = static_cast<uInt>(packed.size());
  for (std::size_t done = 0; done < size; done += zeros.size()) {
    stream.next_in = zeros.data();
    stream.avail_in = static_cast<uInt>(zeros.size());
    const bool is_last = done + zeros.size() >= size;
    EXPECT_EQ(deflate(&stream, is_last ? Z_FINISH : Z_NO_FLUSH), is_last ? Z_STREAM_END : Z_OK);
  }
  packed.resize(stream.total_out);
  deflateEnd(&stream);
  return packed;
}

class HostileImageTest : public ::testing::Test {
 protected:
  Bytes GoodImage() const { return *EncodeGrey16Png(DatasetFolder::Grey(32, 24, 500)); }
  /// A good image with the size in its head changed.
  Bytes ImageThatClaims(std::uint32_t width, std::uint32_t height) const {
    Bytes image = GoodImage();
    Bytes head(image.begin() + 16, image.begin() + 16 + 13);
    Bytes size;
    AppendNumber(width, size);
    AppendNumber(height, size);
    std::copy(size.begin(), size.end(), head.begin());
    const Bytes chunk = Chunk("IHDR", head);
    std::copy(chunk.begin(), chunk.end(), image.begin() + 8);
    return image;
  }
  Measured Import() {
    return RunMeasured({"import", dataset_.path(), "-o", dataset_.root() / "scan.mcap", "--force"},
                       dataset_.root() / "output");
  }
  void ReplaceWith(const Bytes& image) const { dataset_.WriteBytes("depth/1.png", image); }

  DatasetFolder dataset_;
};

TEST_F(HostileImageTest, F65AHeadThatClaimsBillionsOfPixelsIsRefused) {
  const Bytes image = ImageThatClaims(60'000, 60'000);
  ReplaceWith(image);
  const Measured run = Import();
  ExpectModest(run, "import", image.size());
  EXPECT_NE(run.status, 0);
  EXPECT_THAT(run.output, HasSubstr("depth/1.png"));
}

TEST_F(HostileImageTest, F65TextThatUnpacksToAGigabyteIsNotUnpacked) {
  const Bytes packed = PackedZeros(1'000'000'000);
  for (const char* kind : {"zTXt", "iCCP"}) {
    Bytes text = {'a', 0, 0};  // A name, and how it is packed.
    text.insert(text.end(), packed.begin(), packed.end());
    Bytes image = GoodImage();
    const Bytes chunk = Chunk(kind, text);
    image.insert(image.begin() + kHeadEnd, chunk.begin(), chunk.end());
    ReplaceWith(image);
    const Measured run = Import();
    ExpectModest(run, kind, image.size());
    EXPECT_EQ(run.status, 0) << "the image itself is good\n" << run.output;
  }
}

TEST_F(HostileImageTest, F65PixelsThatUnpackToMoreThanTheImageAreNotUnpacked) {
  const Bytes good = GoodImage();
  Bytes image(good.begin(), good.begin() + kHeadEnd);
  for (const Bytes& chunk : {Chunk("IDAT", PackedZeros(1'000'000'000)), Chunk("IEND", {})})
    image.insert(image.end(), chunk.begin(), chunk.end());
  ReplaceWith(image);
  ExpectModest(Import(), "import", image.size());
}

/// Another format by the name of the one that is read.
TEST_F(HostileImageTest, F65AnotherFormatIsNoImage) {
  for (const std::string head : {"II*\0", "BM", "GIF89a", "%PDF-1.4"}) {
    Bytes image(head.begin(), head.end());
    image.resize(17'000, 0xFF);
    ReplaceWith(image);
    const Measured run = Import();
    ExpectModest(run, "import", image.size());
    EXPECT_NE(run.status, 0) << head;
  }
}

}  // namespace
}  // namespace isotherm::system_test
