#pragma once

#include <cstdint>
#include <filesystem>
#include <span>

#include "common/base/status.h"

namespace isotherm {

/// Writes a file so that a reader finds the old content or the new, never a part: into
/// `PATH.partial` beside it, which must not be a link, then renamed. Not synced to the disk: it is
/// only for looking at.
Status ReplaceFile(const std::filesystem::path& path, std::span<const std::uint8_t> bytes);

}  // namespace isotherm
