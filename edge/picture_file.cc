#include "edge/picture_file.h"

#include <fstream>

namespace isotherm {

Status ReplaceFile(const std::filesystem::path& path, std::span<const std::uint8_t> bytes) {
  std::filesystem::path partial = path;
  partial += ".partial";
  std::ofstream file(partial, std::ios::binary | std::ios::trunc);
  file.write(reinterpret_cast<const char*>(bytes.data()),
             static_cast<std::streamsize>(bytes.size()));
  file.close();
  if (!file) return IoError(partial.string() + ": cannot be written; is there such a folder?");
  std::error_code error;
  std::filesystem::rename(partial, path, error);
  if (error) return IoError(path.string() + ": cannot be replaced: " + error.message());
  return OkStatus();
}

}  // namespace isotherm
