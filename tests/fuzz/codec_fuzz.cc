// A payload: the first bytes say which code and which size.
#include <cstdlib>

#include "common/codec/codec.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  constexpr std::size_t kHeadBytes = 3;
  if (size < kHeadBytes) return 0;
  // One more than there are: unknown ones come too.
  constexpr int kEncodings = static_cast<int>(isotherm::kLastEncoding) + 2;
  const isotherm::EncodedImage image{
      .encoding = static_cast<isotherm::Encoding>(data[0] % kEncodings),
      .width = data[1],
      .height = data[2],
      .payload = {data + kHeadBytes, data + size}};
  const auto pixels = isotherm::Decode(image);
  if (pixels && (pixels->width() != image.width || pixels->height() != image.height)) std::abort();
  return 0;
}
