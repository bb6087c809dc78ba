#pragma once

#include <chrono>
#include <filesystem>
#include <string>
#include <vector>

#include "common/time/time_types.h"

namespace isotherm {

/// A file of a recording: which one, and which part of it, its name says.
struct ListedRecording {
  std::filesystem::path path;
  std::filesystem::path first;  ///< The recording's first file.
  int part = 1;
  std::filesystem::file_time_type written;

  /// Returns the same on the wall clock.
  CaptureTime WrittenAt() const {
    const auto since = std::chrono::file_clock::to_sys(written).time_since_epoch();
    return CaptureTime(std::chrono::duration_cast<Nanoseconds>(since));
  }
};

/// Returns the files of all recordings that `record` names (see RecordingPath), the one that was
/// written last first: those that an edge has written into the folder, or the parts of the file.
/// Nothing for "off" and for what is not there.
std::vector<ListedRecording> ListRecordings(const std::filesystem::path& record);

}  // namespace isotherm
