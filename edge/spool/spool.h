#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>

#include "common/base/status.h"
#include "common/recording/recording.h"
#include "common/time/time_types.h"
#include "common/transport/messages.h"
#include "edge/encoded_frame.h"
#include "edge/frame_account.h"

namespace isotherm {

class SpoolOptions;

/// The file that `record` means: as given, or named by `now` in the folder that it names; nullopt
/// for "off".
std::optional<std::filesystem::path> SpoolPath(const std::string& record, CaptureTime now);

/// The recording on the edge's own disk, with the shutter events that the thermal frames tell of
/// and the steps of the wall clock. After the first write error (disk full) it says so once, keeps
/// what is good and only counts. Thread-bound: one thread adds and closes.
class Spool {
 public:
  using Metadata = std::map<std::string, std::map<std::string, std::string>>;

  static Result<std::unique_ptr<Spool>> Create(const std::filesystem::path& path,
                                               const SpoolOptions& options,
                                               const std::optional<Rig>& rig,
                                               const Metadata& metadata, FrameAccount& account);
  /// For a writer of any kind. `account` must outlive the spool.
  Spool(std::filesystem::path path, std::unique_ptr<RecordingWriter> writer, FrameAccount& account);

  void Add(const EncodedFrame& frame);
  /// `arrival` on the edge's wall clock.
  void Add(const Feedback& feedback, CaptureTime arrival);
  /// Writes the summary. The first error of the whole recording, or ok.
  Status Close();

  const std::filesystem::path& path() const { return path_; }

 private:
  Status WriteFrame(const EncodedFrame& frame);
  void NoteShutter(const EncodedThermalFrame& frame);
  /// A step that a dropped frame would have told of is told by the next one.
  Status WriteClockStep(const EncodedFrame& frame);
  void NoteError(const Status& status);
  void UpdateAccount();

  const std::filesystem::path path_;
  const std::unique_ptr<RecordingWriter> writer_;
  FrameAccount& account_;
  Status first_error_;
  std::optional<CaptureTime> newest_;       ///< Capture time of the frames so far.
  std::array<std::uint64_t, 2> offered_{};  ///< By Sensor.
  std::optional<CaptureTime> shutter_closed_at_;
  Nanoseconds wall_minus_time_{0};
};

}  // namespace isotherm
