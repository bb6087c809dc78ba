#pragma once

#include <cstdint>
#include <vector>

#include "common/base/status.h"
#include "ground/renderer/rgb.h"

namespace isotherm {

/// The image as a PNG file in memory.
Result<std::vector<std::uint8_t>> EncodePng(const RgbImage& image);

}  // namespace isotherm
