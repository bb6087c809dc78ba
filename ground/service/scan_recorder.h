#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "common/base/status.h"
#include "common/frame/frame.h"
#include "common/messages/messages.h"
#include "common/recording/recording.h"
#include "common/time/back_off.h"
#include "common/time/clock.h"
#include "ground/options/ground_options.pb.h"
#include "ground/subscriber/received_frame.h"
#include "ground/subscriber/session_counters.h"

namespace isotherm {

/// Counts one stream's frames: offered = recorded + unwritable + lost.
struct RecorderCounts {
  std::uint64_t offered = 0;
  std::uint64_t recorded = 0;
  std::uint64_t unwritable = 0;  ///< No disk would take them, because they are wrong.
  std::uint64_t lost = 0;        ///< The disk failed.
};

/// Writes what arrives during one session into `scan.mcap`, and after an error of the disk into
/// `scan-2.mcap` and so on.
///
///   recording --(error of the disk)--------------------------> waiting
///   waiting   --(back-off over, a new file can be begun)-----> recording
///
/// After an error the file is closed as well as it can be and never touched again. Each file has
/// the whole beginning; one that failed before it got a frame is removed. A message that is wrong
/// ends nothing and is left out, also at a file's beginning. Thread-compatible.
class ScanRecorder {
 public:
  using CreateWriter =
      std::function<Result<std::unique_ptr<RecordingWriter>>(const std::filesystem::path&)>;

  /// Records to the disk; `path` is the first file's. `clock` must outlive the recorder.
  ScanRecorder(const std::filesystem::path& path, const GroundOptions& options,
               const RigDescription& rig, const Clock& clock);
  /// The same with files that `create` makes.
  ScanRecorder(const std::filesystem::path& path, const GroundOptions& options,
               const RigDescription& rig, const Clock& clock, CreateWriter create);

  /// Begins a file if there is none and one is due. Frames do so as well.
  void Tend();
  void Write(const ReceivedDepth& depth) { WriteFrame(Sensor::kDepth, depth); }
  void Write(const ReceivedThermal& thermal) { WriteFrame(Sensor::kThermal, thermal); }
  /// Writes what is known of the same rig from here on, in this file and in those that follow.
  void Write(const RigDescription& rig);
  void Write(const Feedback& feedback);
  void Write(const ExternalOdometrySample& sample);
  /// Writes it into the next file if there is none now.
  void Write(const ScanMark& mark);
  /// Keeps what is known of the rig's clock, and writes what changed in kind: synchronisation,
  /// steps, alarm.
  void Write(const SessionClock& clock);
  /// Hands what was written so far to the operating system.
  void Flush();
  /// Ends the file in order because of `why`, the newest failure; the next frame begins another
  /// one.
  void EndFile(const Status& why);
  /// Writes index and footer, and returns status(). Idempotent.
  Status Close();

  RecorderCounts counts(Sensor sensor) const;
  /// Returns the bytes of all files.
  std::uint64_t bytes() const;
  /// Returns the files in their order, the newest last; none that was removed.
  const std::vector<std::filesystem::path>& files() const { return files_; }
  /// Returns why the newest file that did not last ended, or if all did, the newest message that
  /// was wrong, or ok.
  const Status& status() const { return end_.ok() ? refusal_ : end_; }
  /// Returns the disk's newest error, or ok.
  const Status& disk_error() const { return disk_error_; }
  bool is_recording() const { return writer_ != nullptr; }

 private:
  template <typename Frame>
  void WriteFrame(Sensor sensor, const Frame& frame);
  Status BeginFile();
  void WriteBeginning();
  void WriteRig();
  void WriteMarks();
  Status WriteClockStep();
  Status WriteClockMetadata();
  /// An error of the disk ends the file; a message that was wrong ends nothing.
  void Note(const Status& status);
  /// The file cannot go on, or could not be begun: another one later.
  void Fail(const Status& status);
  void NoteWorks();
  /// Returns the first error of the file up to its closing, or ok.
  Status CloseFile();
  std::uint64_t Lost() const;

  const std::filesystem::path path_;
  const std::string options_text_;
  RigDescription rig_;
  const Clock& clock_;
  const CreateWriter create_;
  std::unique_ptr<RecordingWriter> writer_;
  int part_ = 0;  ///< The newest file's number.
  std::vector<std::filesystem::path> files_;
  RecordingStats closed_{};                    ///< Sum over the files before.
  std::array<std::uint64_t, 2> offered_{};     ///< By Sensor.
  std::array<std::uint64_t, 2> unwritable_{};  ///< By Sensor.
  Status end_;                                 ///< The newest end of a file that was not wanted.
  Status disk_error_;                          ///< The newest.
  Status refusal_;                             ///< The newest.
  bool failing_ = false;                       ///< The disk has failed and not proven itself since.
  std::uint64_t lost_before_ = 0;              ///< When all was well last.
  BackOff back_off_;
  SteadyTime retry_at_{};
  SteadyTime begun_at_{};                  ///< The newest file.
  std::vector<ScanMark> marks_;            ///< No file has them yet.
  std::optional<SessionClock> rig_clock_;  ///< The newest.
  double step_sum_s_ = 0.0;                ///< As the newest file says.
};

}  // namespace isotherm
