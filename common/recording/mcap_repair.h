#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>

#include "common/base/status.h"

namespace isotherm::mcap {

/// Completes a file whose writer did not: cuts off what is not whole behind the last good chunk,
/// and appends the summary, in place. Returns how many bytes were cut off; nullopt for a file that
/// is complete, which stays as it is. kFailedPrecondition for a file that this does not help: with
/// damage before its end, with records that Isotherm does not write, or without any chunk; and
/// while another program writes it.
Result<std::optional<std::uint64_t>> CompleteFile(const std::filesystem::path& path);

}  // namespace isotherm::mcap
