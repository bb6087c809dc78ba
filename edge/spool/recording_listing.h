#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace isotherm {

/// A file of a recording: which one, and which part of it, its name says.
struct ListedRecording {
  std::filesystem::path path;
  std::filesystem::path first;  ///< The recording's first file.
  int part = 1;
  std::filesystem::file_time_type written;
};

/// Returns the files of all recordings that `record` names (see RecordingPath), the one that was
/// written last first: those that an edge has written into the folder, or the parts of the file.
/// Nothing for "off" and for what is not there.
std::vector<ListedRecording> ListRecordings(const std::filesystem::path& record);

}  // namespace isotherm
