#pragma once

#include <cstdint>
#include <filesystem>

#include "common/base/status.h"
#include "common/frame/image.h"

namespace isotherm {

/// Reads a grey image with 16 bits per pixel (PNG, or another lossless format that OpenCV knows) of
/// exactly width x height pixels. kDataLoss names the file and what is wrong: 8 bits, several
/// channels, another size, not an image, damaged.
Result<Image<std::uint16_t>> ReadGrey16(const std::filesystem::path& path, int width, int height);

}  // namespace isotherm
