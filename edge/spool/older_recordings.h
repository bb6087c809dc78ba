#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "common/base/status.h"

namespace isotherm {

/// Notes beside a recording's file that it was fetched whole as it is now. kNotFound if there is no
/// such file of `size` bytes, kIoError if the disk does not take the note.
Status MarkFetched(const std::filesystem::path& file, std::uint64_t size);
/// Returns whether it was, and has not changed its size since.
bool IsFetched(const std::filesystem::path& file);

/// Says what was deleted to make room.
struct DeletedRecording {
  std::string name;  ///< Its first file's.
  std::uint64_t bytes = 0;
};
/// Says which file of a recording was.
struct DeletedFile {
  std::filesystem::path path;
  bool is_of_present = false;  ///< The recording that is being written had it.
  bool was_fetched = false;
};

/// Returns what all recordings that `record` names (see RecordingPath) take by now, bytes.
std::uint64_t RecordingsSize(const std::filesystem::path& record);
/// Returns what those of them take that were fetched whole, in all their files, and are not the one
/// whose first file is `present`; bytes.
std::uint64_t FetchedSize(const std::filesystem::path& record,
                          const std::filesystem::path& present);
/// Deletes all files of the recording that was written first of those; nullopt if there is none, or
/// none can be deleted.
std::optional<DeletedRecording> DeleteOldestFetched(const std::filesystem::path& record,
                                                    const std::filesystem::path& present);
/// Deletes one file, fetched or not, unless somebody writes it: of recordings other than the one
/// whose first file is `present` the one that was written first, then the first of that; nullopt if
/// there is none, or none can be deleted.
std::optional<DeletedFile> DeleteOldestFile(const std::filesystem::path& record,
                                            const std::filesystem::path& present);

}  // namespace isotherm
