#pragma once

#include <filesystem>

#include "common/base/status.h"
#include "ground/renderer/rgb.h"

namespace isotherm {

/// Writes a rendering as PNG; the file appears only when it is complete. Messages name it.
Status WritePng(const RgbImage& rendering, const std::filesystem::path& path);

}  // namespace isotherm
