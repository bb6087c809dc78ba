#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "common/frame/frame.h"
#include "common/messages/messages.h"
#include "common/time/time_types.h"
#include "edge/spool/recording_files.h"

namespace isotherm {

/// This metadata of a recording says which scan of which rig it is a part of.
inline constexpr std::string_view kScanMetadata = "scan";

/// Holds what stands there.
struct ScanPart {
  std::string edge_id;
  std::uint64_t session = 0;
  CaptureTime begun{};  ///< The process that wrote the file.
  std::array<std::uint64_t, 2>
      first_numbers{};  ///< Numbers of that process's frames begin here, by Sensor.
};
std::map<std::string, std::string> ToMetadata(const ScanPart& part);

/// Tells of frames in a row that a file has, some of which it may lack after all.
struct RecordedRun {
  std::filesystem::path file;
  Sensor sensor{};
  FrameRange frames;
  CaptureTime time{};  ///< The first one's.
};

/// Tells what a scan had recorded of one stream.
struct RecordedStream {
  std::uint64_t frames = 0;  ///< How many.
  /// Numbers below are in no file any more: deleted, to keep the newest.
  std::uint64_t deleted = 0;
  std::uint64_t next = 0;  ///< One above the highest number.
  double rate_hz = 0.0;    ///< Numbers per second at the end; 0: not known.
};

/// A scan that did not end: its process did, without closing the recording. Another process can go
/// on with it.
struct InterruptedScan {
  std::filesystem::path path;             ///< The first file's.
  int parts = 0;                          ///< The number of the newest file.
  CaptureTime newest{};                   ///< Frame.
  std::array<RecordedStream, 2> streams;  ///< By Sensor.
  std::vector<RecordedRun> runs;          ///< File by file, and ascending in each stream.
  ScanPart last;                          ///< The newest file's, which may have no frames.
  std::optional<Rig> rig;                 ///< As it says.
  RecordingDescription::Metadata metadata;

  const RecordedStream& Of(Sensor sensor) const {
    return streams[static_cast<std::size_t>(sensor)];
  }
  /// Returns the number that the first frame of a process may have that goes on at `now`: those
  /// before may have published frames which they had not recorded yet, and numbers advance no
  /// faster than the camera does.
  std::uint64_t NextNumber(Sensor sensor, CaptureTime now) const;
};

/// Returns the newest scan of `edge_id` among the recordings that `record` names (see
/// RecordingPath), if it was interrupted, nobody writes it any more, it was written last no longer
/// than `max_age` before `now`, a time of the wall clock, and its frames lie before that. A file
/// that cannot be read is passed over.
std::optional<InterruptedScan> FindInterruptedScan(const std::string& record,
                                                   const std::string& edge_id, CaptureTime now,
                                                   Nanoseconds max_age);

}  // namespace isotherm
