#include "common/png/png.h"

#include <fmt/format.h>
#include <png.h>

#include <algorithm>
#include <array>
#include <bit>
#include <csetjmp>
#include <cstring>
#include <limits>
#include <string>

namespace isotherm {
namespace {

using Bytes = std::span<const std::uint8_t>;

constexpr std::array<std::uint8_t, 16> kStart = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1A, '\n',
                                                 0,    0,   0,   13,  'I',  'H',  'D',  'R'};
/// Signature, chunk length and name, then width, height, bits and colour type.
constexpr std::size_t kHeadBytes = kStart.size() + 4 + 4 + 2;
/// The level of zlib, 0..9: half the size that run lengths only give shaded surfaces.
constexpr int kCompression = 6;
constexpr int kFastCompression = 1;
/// Deflate packs at most 1032 bytes into one.
constexpr std::uint64_t kMaxRatio = 1032;

std::uint32_t BigEndian32(Bytes bytes) {
  return (std::uint32_t{bytes[0]} << 24) | (std::uint32_t{bytes[1]} << 16) |
         (std::uint32_t{bytes[2]} << 8) | bytes[3];
}

int ChannelsOf(std::uint8_t colour_type) {
  switch (colour_type) {
    case PNG_COLOR_TYPE_GRAY:
      return 1;
    case PNG_COLOR_TYPE_GRAY_ALPHA:
      return 2;
    case PNG_COLOR_TYPE_RGB:
    case PNG_COLOR_TYPE_PALETTE:
      return 3;
    default:
      return 4;
  }
}

/// Holds what libpng reads from or writes to, and what it says if it fails.
struct Stream {
  Bytes rest;                                ///< The part of the file that is not read yet.
  std::vector<std::uint8_t>* out = nullptr;  ///< The file that is written.
  std::array<char, 128> error{};
};

extern "C" {
void OnPngError(png_structp png, png_const_charp message) {
  auto& stream = *static_cast<Stream*>(png_get_error_ptr(png));
  std::strncpy(stream.error.data(), message, stream.error.size() - 1);
  png_longjmp(png, 1);
}
void OnPngWarning(png_structp /*png*/, png_const_charp /*message*/) {}

void ReadPngBytes(png_structp png, png_bytep out, std::size_t count) {
  auto& stream = *static_cast<Stream*>(png_get_io_ptr(png));
  if (count > stream.rest.size()) png_error(png, "it ends too early");
  std::memcpy(out, stream.rest.data(), count);
  stream.rest = stream.rest.subspan(count);
}
void WritePngBytes(png_structp png, png_bytep bytes, std::size_t count) {
  auto& stream = *static_cast<Stream*>(png_get_io_ptr(png));
  stream.out->insert(stream.out->end(), bytes, bytes + count);
}
void FlushPng(png_structp /*png*/) {}
}

/// Owns libpng's structures.
class PngReader {
 public:
  explicit PngReader(Stream& stream)
      : png_(png_create_read_struct(PNG_LIBPNG_VER_STRING, &stream, OnPngError, OnPngWarning)),
        info_(png_ != nullptr ? png_create_info_struct(png_) : nullptr) {
    if (info_ != nullptr) png_set_read_fn(png_, &stream, ReadPngBytes);
  }
  ~PngReader() { png_destroy_read_struct(&png_, &info_, nullptr); }
  PngReader(const PngReader&) = delete;
  PngReader& operator=(const PngReader&) = delete;

  bool ok() const { return info_ != nullptr; }

  /// libpng reports errors by a jump: nothing in here has a destructor.
  bool Decode(std::uint32_t width, std::uint32_t height, png_bytep pixels, std::size_t row_bytes) {
    if (setjmp(png_jmpbuf(png_)) != 0) return false;
    // Text and colour profiles of any length could be in a file; nothing is kept of them.
    constexpr int kAllButPixels = -1;
    png_set_keep_unknown_chunks(png_, PNG_HANDLE_CHUNK_NEVER, nullptr, kAllButPixels);
    // The head was read before: a second, larger one must not decide what is allocated.
    png_set_user_limits(png_, width, height);
    png_set_crc_action(png_, PNG_CRC_ERROR_QUIT, PNG_CRC_QUIET_USE);
    png_read_info(png_, info_);
    if (png_get_rowbytes(png_, info_) != row_bytes) return false;
    // PNG is big-endian.
    if (std::endian::native == std::endian::little) png_set_swap(png_);
    const int passes = png_set_interlace_handling(png_);
    png_read_update_info(png_, info_);
    for (int pass = 0; pass < passes; ++pass) {
      for (std::uint32_t y = 0; y < height; ++y)
        png_read_row(png_, pixels + y * row_bytes, nullptr);
    }
    png_read_end(png_, nullptr);
    return true;
  }

 private:
  png_structp png_;
  png_infop info_;
};

class PngWriter {
 public:
  explicit PngWriter(Stream& stream)
      : png_(png_create_write_struct(PNG_LIBPNG_VER_STRING, &stream, OnPngError, OnPngWarning)),
        info_(png_ != nullptr ? png_create_info_struct(png_) : nullptr) {
    if (info_ != nullptr) png_set_write_fn(png_, &stream, WritePngBytes, FlushPng);
  }
  ~PngWriter() { png_destroy_write_struct(&png_, &info_); }
  PngWriter(const PngWriter&) = delete;
  PngWriter& operator=(const PngWriter&) = delete;

  bool ok() const { return info_ != nullptr; }

  /// As for PngReader::Decode: nothing in here has a destructor.
  bool Encode(const PngPixels& pixels, std::size_t row_bytes) {
    if (setjmp(png_jmpbuf(png_)) != 0) return false;
    png_set_IHDR(png_, info_, static_cast<png_uint_32>(pixels.width),
                 static_cast<png_uint_32>(pixels.height), pixels.bits,
                 pixels.channels == 1 ? PNG_COLOR_TYPE_GRAY : PNG_COLOR_TYPE_RGB,
                 PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    png_set_compression_level(png_, pixels.is_fleeting ? kFastCompression : kCompression);
    png_set_compression_strategy(png_, 0);  // Z_DEFAULT_STRATEGY
    png_write_info(png_, info_);
    if (pixels.bits == 16 && std::endian::native == std::endian::little) png_set_swap(png_);
    for (int y = 0; y < pixels.height; ++y)
      png_write_row(png_, pixels.bytes.data() + static_cast<std::size_t>(y) * row_bytes);
    png_write_end(png_, info_);
    return true;
  }

 private:
  png_structp png_;
  png_infop info_;
};

/// Decodes a grey image of one value per pixel, everything checked before anything is allocated.
template <typename T>
Status DecodeGrey(Bytes file, int bits, Image<T>& image) {
  const Result<PngHead> head = ReadPngHead(file);
  if (!head) return head.error();
  const auto width = static_cast<std::uint32_t>(image.width());
  const auto height = static_cast<std::uint32_t>(image.height());
  if (head->width != width || head->height != height || head->channels != 1 || head->bits != bits) {
    return DataLoss(fmt::format(
        "is a PNG of {} x {} pixels, {} channels of {} bits, not of {} x {} pixels, {}-bit grey",
        head->width, head->height, head->channels, head->bits, width, height, bits));
  }
  if (image.empty() || image.size() * sizeof(T) / kMaxRatio > file.size()) {
    return DataLoss(
        fmt::format("is damaged: {} bytes cannot hold {} x {} pixels", file.size(), width, height));
  }
  Stream stream{.rest = file};
  PngReader reader(stream);
  if (!reader.ok()) return Internal("libpng cannot be used");
  const std::size_t row_bytes = std::size_t{width} * sizeof(T);
  if (!reader.Decode(width, height, reinterpret_cast<png_bytep>(image.data()), row_bytes)) {
    return DataLoss(fmt::format("is damaged: {}", stream.error.data()));
  }
  return OkStatus();
}

}  // namespace

Result<PngHead> ReadPngHead(std::span<const std::uint8_t> file) {
  if (file.size() < kHeadBytes || !std::equal(kStart.begin(), kStart.end(), file.begin())) {
    return Err(DataLoss("is damaged or not a PNG file, the only image format that is read"));
  }
  return PngHead{.width = BigEndian32(file.subspan(16)),
                 .height = BigEndian32(file.subspan(20)),
                 .channels = ChannelsOf(file[25]),
                 .bits = file[24]};
}

Status DecodeGrey16Png(std::span<const std::uint8_t> file, Image<std::uint16_t>& image) {
  return DecodeGrey(file, 16, image);
}

Status DecodeGrey8Png(std::span<const std::uint8_t> file, Image<std::uint8_t>& image) {
  return DecodeGrey(file, 8, image);
}

Result<std::vector<std::uint8_t>> EncodePng(const PngPixels& pixels) {
  if (pixels.width <= 0 || pixels.height <= 0)
    return Err(InvalidArgument("an image without pixels cannot become a PNG"));
  const std::size_t row_bytes = static_cast<std::size_t>(pixels.width) *
                                static_cast<std::size_t>(pixels.channels * pixels.bits / 8);
  CHECK(pixels.bytes.size() == row_bytes * static_cast<std::size_t>(pixels.height));
  std::vector<std::uint8_t> file;
  Stream stream{.rest = {}, .out = &file};
  PngWriter writer(stream);
  if (!writer.ok()) return Err(Internal("libpng cannot be used"));
  if (!writer.Encode(pixels, row_bytes)) {
    return Err(Internal(fmt::format("encoding a PNG: {}", stream.error.data())));
  }
  return file;
}

Result<std::vector<std::uint8_t>> EncodeGrey16Png(const Image<std::uint16_t>& image) {
  const auto* const bytes = reinterpret_cast<const std::uint8_t*>(image.data());
  return EncodePng({.width = image.width(),
                    .height = image.height(),
                    .channels = 1,
                    .bits = 16,
                    .bytes = {bytes, image.size() * sizeof(std::uint16_t)}});
}

}  // namespace isotherm
