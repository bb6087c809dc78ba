#pragma once

#include <cstdint>
#include <filesystem>

#include "common/base/status.h"

namespace isotherm::mcap {

/// Completes a file whose writer did not: cuts off what is not whole behind the last good chunk,
/// and appends the summary, in place. Returns how many bytes were cut off; 0 also for a file that
/// is complete, which stays as it is. kFailedPrecondition for a file that this does not help: with
/// damage before its end, with messages outside chunks, or without any chunk.
Result<std::uint64_t> CompleteFile(const std::filesystem::path& path);

}  // namespace isotherm::mcap
