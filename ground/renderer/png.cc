#include "ground/renderer/png.h"

#include <span>

#include "common/png/png.h"

namespace isotherm {

Result<std::vector<std::uint8_t>> EncodePng(const RgbImage& picture) {
  const auto* const bytes = reinterpret_cast<const std::uint8_t*>(picture.data());
  return EncodePng(PngPixels{.width = picture.width(),
                             .height = picture.height(),
                             .channels = 3,
                             .bits = 8,
                             .bytes = {bytes, picture.size() * sizeof(Rgb8)}});
}

}  // namespace isotherm
