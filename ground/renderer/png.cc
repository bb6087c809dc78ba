#include "ground/renderer/png.h"

#include <span>

#include "common/png/png.h"

namespace isotherm {

Result<std::vector<std::uint8_t>> EncodePng(const RgbImage& image) {
  const auto* const bytes = reinterpret_cast<const std::uint8_t*>(image.data());
  return EncodePng(PngPixels{.width = image.width(),
                             .height = image.height(),
                             .channels = 3,
                             .bits = 8,
                             .bytes = {bytes, image.size() * sizeof(Rgb8)}});
}

}  // namespace isotherm
