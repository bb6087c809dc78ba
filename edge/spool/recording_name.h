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

/// The name of a recording's file number `part`: "scan.mcap", "scan-2.mcap", ...
std::filesystem::path PartPath(const std::filesystem::path& path, int part);

/// Whether it is written to as it is: a device or a pipe, which has no parts.
bool IsDevice(const std::filesystem::path& path);

}  // namespace isotherm
