#include "common/dataset/image_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <iterator>
#include <opencv2/imgcodecs.hpp>
#include <vector>

namespace isotherm {
namespace {

using Bytes = std::vector<unsigned char>;

std::uint32_t BigEndian32(const unsigned char* bytes) {
  return (std::uint32_t{bytes[0]} << 24) | (std::uint32_t{bytes[1]} << 16) |
         (std::uint32_t{bytes[2]} << 8) | bytes[3];
}

Result<Bytes> ReadBytes(const std::filesystem::path& path) {
  errno = 0;
  std::ifstream file(path, std::ios::binary);
  if (!file) {
    const int reason = errno;
    std::string text = fmt::format("cannot be opened: {}", std::strerror(reason));
    return Err(reason == ENOENT ? NotFound(std::move(text)) : IoError(std::move(text)));
  }
  Bytes bytes{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
  if (file.bad()) return Err(IoError("cannot be read"));
  if (bytes.empty()) return Err(DataLoss("is empty"));
  return bytes;
}

Status CheckFormat(std::int64_t width, std::int64_t height, int channels, int bits,
                   int expected_width, int expected_height) {
  if (channels != 1) {
    return DataLoss(fmt::format(
        "has {} channels, expected one channel of 16 bits (raw depth or centi-kelvin, not a "
        "coloured picture)",
        channels));
  }
  if (bits != 16) {
    return DataLoss(
        fmt::format("has {} bits per pixel, expected 16 (save it as 16-bit PNG)", bits));
  }
  if (width != expected_width || height != expected_height) {
    return DataLoss(fmt::format("has {} x {} pixels, but the rig calibration says {} x {}", width,
                                height, expected_width, expected_height));
  }
  return OkStatus();
}

// Checks a PNG by its header before anything of the size it claims is allocated. Other formats
// pass.
Status CheckPngHeader(const Bytes& bytes, int width, int height) {
  constexpr std::string_view kSignature = "\x89PNG\r\n\x1a\n";
  constexpr std::size_t kHeaderBytes =
      26;  // Signature, length, "IHDR", width, height, bits, colour type.
  if (bytes.size() < kHeaderBytes ||
      std::memcmp(bytes.data(), kSignature.data(), kSignature.size()) != 0) {
    return OkStatus();
  }
  constexpr unsigned char kGrey = 0, kColour = 2, kPalette = 3, kGreyAlpha = 4;
  const unsigned char type = bytes[25];
  const int channels = type == kGrey                         ? 1
                       : type == kGreyAlpha                  ? 2
                       : type == kColour || type == kPalette ? 3
                                                             : 4;
  return CheckFormat(BigEndian32(&bytes[16]), BigEndian32(&bytes[20]), channels, bytes[24], width,
                     height);
}

Result<Image<std::uint16_t>> Decoded(const Bytes& bytes, int width, int height) {
  cv::Mat mat;
  try {
    mat = cv::imdecode(bytes, cv::IMREAD_UNCHANGED);
  } catch (const cv::Exception& exception) {
    return Err(DataLoss(fmt::format("cannot be decoded: {}", exception.err)));
  }
  if (mat.empty()) return Err(DataLoss("is damaged or not an image"));
  const int bits = mat.depth() == CV_16U ? 16 : static_cast<int>(8 * mat.elemSize1());
  if (Status status = CheckFormat(mat.cols, mat.rows, mat.channels(), bits, width, height);
      !status.ok()) {
    return Err(std::move(status));
  }
  if (mat.depth() != CV_16U) return Err(DataLoss("is not stored as unsigned 16-bit values"));
  Image<std::uint16_t> image(width, height);
  for (int y = 0; y < height; ++y)
    std::copy_n(mat.ptr<std::uint16_t>(y), width, image.Row(y).begin());
  return image;
}

}  // namespace

Result<Image<std::uint16_t>> ReadGrey16(const std::filesystem::path& path, int width, int height) {
  const auto with_path = [&](const Status& status) {
    return Err(status.WithContext(path.string()));
  };
  const Result<Bytes> bytes = ReadBytes(path);
  if (!bytes) return with_path(bytes.error());
  if (Status status = CheckPngHeader(*bytes, width, height); !status.ok()) return with_path(status);
  Result<Image<std::uint16_t>> image = Decoded(*bytes, width, height);
  if (!image) return with_path(image.error());
  return image;
}

}  // namespace isotherm
