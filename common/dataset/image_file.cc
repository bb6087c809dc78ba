#include "common/dataset/image_file.h"

#include <fmt/format.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <vector>

#include "common/png/png.h"

namespace isotherm {
namespace {

using Bytes = std::vector<std::uint8_t>;

constexpr std::streamoff kMaxFileBytes = 64 << 20;

Result<Bytes> ReadBytes(const std::filesystem::path& path) {
  errno = 0;
  std::ifstream file(path, std::ios::binary);
  if (!file) {
    const int reason = errno;
    std::string text = fmt::format("cannot be opened: {}", std::strerror(reason));
    return Err(reason == ENOENT ? NotFound(std::move(text)) : IoError(std::move(text)));
  }
  file.seekg(0, std::ios::end);
  const auto size = static_cast<std::streamoff>(file.tellg());
  if (!file || size < 0) return Err(IoError("cannot be read"));
  if (size == 0) return Err(DataLoss("is empty"));
  if (size > kMaxFileBytes) {
    return Err(DataLoss(
        fmt::format("has {} bytes, more than an image can ({} at most)", size, kMaxFileBytes)));
  }
  Bytes bytes(static_cast<std::size_t>(size));
  file.seekg(0);
  file.read(reinterpret_cast<char*>(bytes.data()), size);
  if (!file) return Err(IoError("cannot be read"));
  return bytes;
}

Status CheckFormat(const PngHead& head, int width, int height) {
  if (head.channels != 1) {
    return DataLoss(fmt::format(
        "has {} channels, expected one channel of 16 bits (raw depth or centi-kelvin, not a "
        "coloured image)",
        head.channels));
  }
  if (head.bits != 16) {
    return DataLoss(
        fmt::format("has {} bits per pixel, expected 16 (save it as 16-bit PNG)", head.bits));
  }
  if (head.width != static_cast<std::uint32_t>(width) ||
      head.height != static_cast<std::uint32_t>(height)) {
    return DataLoss(fmt::format("has {} x {} pixels, but the rig calibration says {} x {}",
                                head.width, head.height, width, height));
  }
  return OkStatus();
}

}  // namespace

Result<Image<std::uint16_t>> ReadGrey16(const std::filesystem::path& path, int width, int height) {
  const auto with_path = [&](const Status& status) {
    return Err(status.WithContext(path.string()));
  };
  const Result<Bytes> bytes = ReadBytes(path);
  if (!bytes) return with_path(bytes.error());
  const Result<PngHead> head = ReadPngHead(*bytes);
  if (!head) return with_path(head.error());
  if (Status status = CheckFormat(*head, width, height); !status.ok()) return with_path(status);
  Image<std::uint16_t> image(width, height);
  if (Status status = DecodeGrey16Png(*bytes, image); !status.ok()) return with_path(status);
  return image;
}

}  // namespace isotherm
