#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "common/base/status.h"
#include "common/concurrency/latest_value.h"
#include "common/messages/messages.h"
#include "common/recording/quota_watch.h"
#include "common/recording/recording.h"
#include "common/time/back_off.h"
#include "common/time/clock.h"
#include "edge/frame_counters/frame_counters.h"
#include "edge/spool/disk_watch.h"
#include "edge/spool/encoded_frame.h"
#include "edge/spool/older_recordings.h"
#include "edge/spool/recorded_frames.h"

namespace isotherm {

class SpoolOptions;
struct InterruptedScan;

Status Validate(const SpoolOptions& options);

/// One file of a recording.
struct RecordingFile {
  std::filesystem::path path;
  std::unique_ptr<RecordingWriter> writer;
};

/// Says what a camera that came late has changed.
struct RigUpdate {
  std::optional<Rig> rig;
  std::map<std::string, std::string> cameras;  ///< Metadata.
};

/// Holds what a spool is put together from. `clock` and `counters` must outlive it.
struct SpoolParts {
  /// Begins the recording's next file, with all that stands at a file's beginning.
  std::function<Result<RecordingFile>()> next_file;
  /// Says how much is free on the disk that it records to.
  std::function<Result<std::uint64_t>()> free_bytes;
  const SpoolOptions& options;
  const Clock& clock;
  FrameCounters& counters;
  /// Takes what stands at the beginning of the next files from now on. May be empty.
  std::function<void(const RigUpdate&)> update{};
  /// Tells what the recording has already of a scan that goes on; nullptr: a new one. Need not
  /// outlive the construction.
  const InterruptedScan* before = nullptr;
  /// Says what all recordings take by now, this one included, for the quota. May be empty.
  std::function<std::uint64_t()> recordings_size{};
  /// Says what older recordings take that may be deleted. May be empty.
  std::function<std::uint64_t()> deletable_size{};
  /// Deletes the one of them that may go first; nullopt: none may. May be empty.
  std::function<std::optional<DeletedRecording>()> make_room{};
  /// Deletes the oldest file of all, to keep the newest; nullopt: none can be. May be empty.
  std::function<std::optional<DeletedFile>()> delete_oldest{};
};

/// Holds the state of the recording.
struct SpoolStatus {
  std::filesystem::path path;                                ///< The newest file's.
  std::optional<std::uint64_t> free_bytes;                   ///< Absent: not known.
  double left_s = std::numeric_limits<double>::quiet_NaN();  ///< Until it ends for lack of space.
  /// Both say what is wrong and what to do, in a sentence and in a few words; empty if nothing is.
  std::string problem;
  std::string brief;
  bool is_full = false;      ///< The recording has ended for lack of space.
  double frame_bytes = 0.0;  ///< Mean size in the recording, of both cameras.
  double keeps_s = 0.0;      ///< So much of the scan is kept; 0: all of it, NaN: not known yet.
};

/// The recording on the edge's own disk, with the shutter events that the thermal frames tell of
/// and the steps of the wall clock.
///
///   recording --(error)----------> waiting --(back-off over, a new file can be begun)--> recording
///   recording --(reserve left)---> full ----(space was made, a new file)---------------> recording
///
/// After an error the file is closed as it is, for what the disk did with it is not known, and
/// never touched again; frames that no file has are counted. At the reserve, or at the end of the
/// quota, it is closed properly, unless older recordings may be deleted. Where the newest is kept,
/// a recording has files of an eighth of the quota, of which the oldest are deleted.
/// A file that got no frame is removed. Nothing of this ends the scan. Thread-bound but for
/// status(): one thread adds, tends and closes.
class Spool {
 public:
  explicit Spool(SpoolParts parts);

  /// Begins the first file at once, for who wants to know whether that is possible: the error, or
  /// ok. Otherwise Tend() begins it, again and again if need be.
  Status Begin();
  void Add(const EncodedFrame& frame);
  /// Describes the rig anew, in this file and in those that follow.
  void Add(const RigUpdate& update);
  /// `arrival` on the edge's wall clock.
  void Add(const Feedback& feedback, CaptureTime arrival);
  /// Goes into the next file if there is none now.
  void Add(const RecordedLog& line);
  /// To be called several times a second. `idle`: no frame came for a moment, so that nothing but
  /// this brings to the disk what is still collected.
  void Tend(bool idle);
  /// Writes the summary. The first error of the whole recording, or ok.
  Status Close();

  /// Returns what the recording has. Thread-safe, as long as the spool lives.
  RecordedFrames& recorded_frames() { return recorded_frames_; }

  /// Thread-safe.
  SpoolStatus status() const { return newest_status_.Get().value_or(SpoolStatus()); }

 private:
  bool IsRecording() const { return file_.has_value(); }
  void BeginFileWhenDue();
  void WriteLines();
  Status BeginFile();
  void LookAtDisk();
  void AskForFreeBytes();
  /// Says how much room there is, once the disk has told what is free.
  DiskLevel Measure();
  /// Returns what this recording has written, in all its files.
  std::uint64_t OwnBytes() const;
  /// Deletes what may go, until there is room or nothing more may.
  void MakeRoom();
  bool MayDelete() const;
  bool KeepsNewest() const;
  /// Deletes the oldest files while there is no room, a few at a time. Returns whether any was.
  bool DeleteOldest();
  /// Closes a file that has its part of what is kept: the next one is begun.
  void EndPartWhenDue();
  Status WriteBefore();
  void EndAtReserve();
  Status WriteFrame(const EncodedFrame& frame);
  void NoteRecorded(Sensor sensor, const FrameHeader& header);
  Status WriteRig(const RigUpdate& update);
  void NoteShutter(const EncodedThermalFrame& frame);
  /// A step that a dropped frame would have told of is told by the next one.
  Status WriteClockStep(const EncodedFrame& frame);
  /// Takes over what another process has recorded of the scan.
  void TakeOver(const InterruptedScan& before);
  /// An error of the disk ends the file.
  void Note(const Status& status);
  /// The file cannot go on, or could not be begun: a new one later.
  void Fail(const Status& status);
  void NoteWorks();
  /// The first error of closing it, or ok.
  Status CloseFile();
  void UpdateCounters();
  void UpdateStatus();
  /// Returns how much of the scan is kept, s; 0: all of it, NaN: not known yet.
  double KeptSeconds() const;
  void WarnIfLittleIsKept();
  std::string Brief() const;
  std::uint64_t NotRecorded() const;

  const SpoolParts parts_;
  DiskWatch disk_;
  QuotaWatch quota_;
  std::uint64_t deletable_bytes_ = 0;
  SteadyTime deletable_due_{};  ///< Asked for again.
  /// With so much free, deleting a recording gave nothing.
  std::optional<std::uint64_t> futile_at_;
  std::optional<RecordingFile> file_;
  std::filesystem::path path_;
  RecordingStats closed_{};  ///< Sum over the files before.
  Status first_error_;
  Status problem_;  ///< Ok while all is well.
  bool at_reserve_ = false;
  BackOff back_off_;
  SteadyTime retry_at_{};
  SteadyTime begun_at_{};      ///< The newest file.
  bool is_next_part_ = false;  ///< The next file goes on where one has its part.
  std::uint64_t quota_left_bytes_ = QuotaWatch::kNoQuota;
  bool warned_of_little_ = false;
  SteadyTime next_look_{};
  std::optional<std::uint64_t> free_bytes_;
  bool free_bytes_unknown_ = false;  ///< Asked for, and there was no answer.
  DiskLevel level_ = DiskLevel::kEnough;
  std::optional<CaptureTime> newest_;       ///< Capture time of the frames so far.
  std::array<std::uint64_t, 2> offered_{};  ///< By Sensor.
  std::array<std::uint64_t, 2> next_{};     ///< One above the highest number, by Sensor.
  std::uint64_t taken_over_ = 0;            ///< Frames of processes before.
  std::uint64_t not_recorded_before_ = 0;   ///< When all was well last.
  std::uint64_t refused_ = 0;               ///< Messages that cannot be recorded on any disk.
  std::optional<CaptureTime> shutter_closed_at_;
  Nanoseconds wall_minus_time_{0};          ///< As the newest file says.
  std::vector<RecordedLog> waiting_lines_;  ///< No file has them yet.
  LatestValue<SpoolStatus> newest_status_;
  RecordedFrames recorded_frames_;
};

}  // namespace isotherm
