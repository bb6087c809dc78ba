#pragma once

#include <cstdint>
#include <filesystem>

#include "common/base/status.h"
#include "common/frame/image.h"

namespace isotherm {

/// Reads a grey PNG with 16 bits per pixel of exactly width x height pixels. kDataLoss names the
/// file and what is wrong: 8 bits, several channels, another size, not a PNG, damaged.
Result<Image<std::uint16_t>> ReadGrey16(const std::filesystem::path& path, int width, int height);

}  // namespace isotherm
