#include "ground/export/png_file.h"

#include <span>
#include <vector>

#include "common/base/output_file.h"
#include "ground/renderer/png.h"

namespace isotherm {

Status WritePng(const RgbImage& rendering, const std::filesystem::path& path) {
  const Result<std::vector<std::uint8_t>> png = EncodePng(rendering);
  if (!png) return png.error().WithContext(path.string());
  return WriteFile(path, std::as_bytes(std::span(*png)));
}

}  // namespace isotherm
