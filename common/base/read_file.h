#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "common/base/status.h"

namespace isotherm {

/// Returns the content of a regular file. What is none is refused at once: a pipe would be waited
/// for until somebody writes to it, a device may never end. Each failure names the path.
/// kNotFound: it does not exist; kInvalidArgument: a folder, a pipe or a device; kDataLoss: it is
/// larger than `max_bytes`; kIoError: anything else.
Result<std::string> ReadFile(const std::filesystem::path& path, std::uint64_t max_bytes);

}  // namespace isotherm
