#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>

#include "common/base/status.h"
#include "common/recording/recording.h"

namespace isotherm {

/// Returns the name of a recording's file number `part`: "scan.mcap", "scan-2.mcap", ...
std::filesystem::path PartPath(const std::filesystem::path& path, int part);

/// Returns the number of the first free name after `part`.
int NextFreePart(const std::filesystem::path& path, int part);

/// Returns whether `path` is written to as it is: a device or a pipe has no parts.
bool IsDevice(const std::filesystem::path& path);

/// Returns whether a process that lives writes this recording. Says no where the file system has no
/// locks.
bool IsBeingWritten(const std::filesystem::path& path);

/// Completes a recording whose writer did not (a power cut, a crash), in place: cuts off what is
/// not whole at its end, and appends index and summary, so that any program for MCAP files reads
/// it. Returns how many bytes were cut off; nullopt for one that is complete. kFailedPrecondition
/// for a file that is still written, or is damaged in the middle.
Result<std::optional<std::uint64_t>> CompleteRecording(const std::filesystem::path& path);

/// Returns whether the file cannot go on after a writer's `status`: the disk failed. Otherwise one
/// message was wrong, and the next may be right.
bool EndsFile(const Status& status);

/// Removes a closed file that got no frame, not even one that may be in it (`stats.unsynced`).
/// Returns whether it did.
bool RemoveIfWithoutFrames(const std::filesystem::path& path, const RecordingStats& stats);

}  // namespace isotherm
