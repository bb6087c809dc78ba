#include "common/dataset/image_file.h"

#include <fmt/format.h>

#include <cstdint>
#include <span>
#include <string>

#include "common/base/read_file.h"
#include "common/png/png.h"

namespace isotherm {
namespace {

// A 16-bit image of 16 megapixels is half of it: what is larger is no image of these cameras.
constexpr std::uint64_t kMaxFileBytes = 64 << 20;

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
  const Result<std::string> file = ReadFile(path, kMaxFileBytes);
  if (!file) return Err(file.error());
  if (file->empty()) return with_path(DataLoss("is empty"));
  const std::span bytes(reinterpret_cast<const std::uint8_t*>(file->data()), file->size());
  const Result<PngHead> head = ReadPngHead(bytes);
  if (!head) return with_path(head.error());
  if (Status status = CheckFormat(*head, width, height); !status.ok()) return with_path(status);
  Image<std::uint16_t> image(width, height);
  if (Status status = DecodeGrey16Png(bytes, image); !status.ok()) return with_path(status);
  return image;
}

}  // namespace isotherm
