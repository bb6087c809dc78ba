#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <vector>

#include "common/base/status.h"
#include "common/recording/recording.h"

namespace isotherm {

/// When an item belongs into the scan: of a frame its capture time, of an event its beginning.
CaptureTime TimeOf(const RecordedItem& item);

/// Returns the header of a frame; nullptr for what is none.
const FrameHeader* HeaderOf(const RecordedItem& item);

/// Counts what of a merged recording comes from one of its parts.
struct MergedPart {
  std::filesystem::path path;
  std::uint64_t depth_frames = 0, thermal_frames = 0;
  std::uint64_t damaged = 0;  ///< Messages of it that could not be read.
};

/// Reads recordings of one scan as one recording: each frame and event once, from the first
/// recording that has it whole. A hole in what the ground recorded is so filled from what the rig
/// recorded. Thread-compatible.
class MergedRecording : public RecordingReader {
 public:
  /// kDataLoss if the recordings are of other cameras; otherwise what opening one of them
  /// says.
  static Result<std::unique_ptr<MergedRecording>> OpenAll(
      const std::vector<std::filesystem::path>& paths);

  /// Says what was read so far, in the order of the paths.
  virtual const std::vector<MergedPart>& parts() const = 0;
  /// Not ok, and Next is at its end, once two recordings have frames of different sessions, or a
  /// frame of the same number that was taken at different times: they are of different scans.
  virtual const Status& conflict() const = 0;
  /// Frames between the first and the last one read so far that no recording has, of both cameras.
  virtual std::uint64_t missing() const = 0;
};

}  // namespace isotherm
