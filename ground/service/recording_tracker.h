#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "common/base/enum_array.h"
#include "common/base/mutex.h"
#include "common/base/status.h"
#include "common/frame/frame.h"

namespace isotherm {

/// Says why a received frame is not in the recording.
enum class NotRecorded : std::uint8_t {
  kDiskTooSlow,     ///< The queue to the disk was full.
  kDiskNearlyFull,  ///< The space that is left is for the results.
  kDiskFailed,      ///< Writing failed, or the disk was waited for after that.
  kUnwritable,      ///< The frame itself is wrong.
  kCount
};
/// "disk_too_slow", as in stats.json.
std::string_view ToString(NotRecorded reason);

/// Frames of one stream that the recording does not have, by reason.
using NotRecordedCounts = EnumArray<NotRecorded, std::uint64_t>;
std::uint64_t Sum(const NotRecordedCounts& counts);

/// Holds what became of a session's recording, or what has so far.
struct RecordingProgress {
  std::filesystem::path path{};                ///< The first file's; empty: there is no recording.
  std::vector<std::filesystem::path> files{};  ///< More than one after an error or a full disk.
  /// What came too late for the reconstruction has files of its own, so that each is in the order
  /// of time.
  std::vector<std::filesystem::path> late_files{};
  /// Recordings of an earlier process of the scan, or what is taken for them until they are looked
  /// through; none of the counts below has these frames.
  std::vector<std::filesystem::path> earlier_files{};
  bool is_earlier_in_model = false;  ///< The live model was made of these first.
  std::uint64_t late_frames = 0;  ///< Counts both streams, in these; the next two have them, too.
  std::uint64_t depth_frames = 0;
  std::uint64_t thermal_frames = 0;
  std::uint64_t bytes = 0;
  NotRecordedCounts depth_left_out{};
  NotRecordedCounts thermal_left_out{};
  bool closed = false;  ///< Nothing more will be written: index and footer are on the disk.
  Status status{};      ///< The newest failure.
  Status disk_error{};  ///< The newest failure of the disk itself, not for want of space kept free.
  bool paused = false;  ///< No frame is written at this moment: the disk fails or is nearly full.
  /// Room on the disk as of the newest look at it; 0 bytes per second = not known yet.
  std::uint64_t free_bytes = 0;
  std::uint64_t reserve_bytes = 0;  ///< The recording stops when no more than this is free.
  double bytes_per_s = 0.0;

  /// Returns all files with frames of the scan, the earlier ones first, what came late last.
  std::vector<std::filesystem::path> AllFiles() const;
  /// Returns whether frames of the scan are elsewhere than in the files that are in order.
  bool is_in_parts() const { return late_frames > 0 || !earlier_files.empty(); }
  std::uint64_t left_out() const;
  std::uint64_t left_out(NotRecorded reason) const;
  /// Returns for how long the disk lasts, seconds; NaN = not known yet.
  double left_s() const;
};

/// "disk: 3.2 h left", "disk: 40 min left"; empty if that is not known.
std::string DiskText(const RecordingProgress& progress);

/// The progress of one session's recording, shared by who writes it and who tells. Thread-safe.
class RecordingTracker {
 public:
  RecordingProgress Get() const {
    MutexLock lock(mutex_);
    return progress_;
  }
  /// The progress as soon as it is closed, or as it is after `patience`.
  RecordingProgress WaitUntilClosed(std::chrono::nanoseconds patience) const;
  void CountLeftOut(Sensor sensor, NotRecorded reason);
  /// `change` gets the progress.
  template <typename Change>
  void Update(const Change& change) {
    MutexLock lock(mutex_);
    change(progress_);
    if (progress_.closed) closed_.notify_all();
  }

 private:
  mutable Mutex mutex_;
  mutable std::condition_variable_any closed_;
  RecordingProgress progress_ GUARDED_BY(mutex_);
};

}  // namespace isotherm
