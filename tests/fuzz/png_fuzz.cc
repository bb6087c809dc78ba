// A PNG file of the size that its own head claims, if that is small.
#include "common/png/png.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::span<const std::uint8_t> file(data, size);
  const auto head = isotherm::ReadPngHead(file);
  constexpr std::uint32_t kMaxSide = 64;
  if (!head || head->width > kMaxSide || head->height > kMaxSide) return 0;
  isotherm::Image<std::uint16_t> image(static_cast<int>(head->width),
                                       static_cast<int>(head->height));
  static_cast<void>(isotherm::DecodeGrey16Png(file, image));
  return 0;
}
