#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "common/base/status.h"

namespace isotherm {

/// SHA-256 (FIPS 180-4) in lower-case hexadecimal digits.
std::string Sha256Of(std::string_view bytes);
/// The same of a file, read in pieces. Messages name the file.
Result<std::string> Sha256OfFile(const std::filesystem::path& path);

}  // namespace isotherm
