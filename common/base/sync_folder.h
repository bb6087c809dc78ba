#pragma once

#include <filesystem>

namespace isotherm {

/// Makes what was created, renamed or removed in a folder survive a power cut; empty: the current
/// folder. Best effort: some file systems refuse.
void SyncFolder(const std::filesystem::path& folder);

}  // namespace isotherm
