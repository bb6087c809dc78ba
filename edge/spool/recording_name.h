#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "common/time/time_types.h"

namespace isotherm {

/// The file that `record` means: as given, or in the folder that it names a file of its own for
/// each session; nullopt for "off". The time in the name is for people: without a clock that is
/// set, or with two sessions in one second, it is the session that makes names differ.
std::optional<std::filesystem::path> RecordingPath(const std::string& record, CaptureTime now,
                                                   std::uint64_t session);

}  // namespace isotherm
