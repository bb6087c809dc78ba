#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <filesystem>
#include <optional>
#include <vector>

#include "common/base/mutex.h"
#include "common/frame/frame.h"
#include "common/messages/messages.h"
#include "common/time/time_types.h"

namespace isotherm {

/// Knows which frames of the session the recording has, and about where. Memory is bounded: of a
/// recording with more gaps than kMaxRuns the oldest frames are forgotten, and the longer it is the
/// fewer places are known. Thread-safe.
class RecordedFrames {
 public:
  /// A point of the recording at or before a frame.
  struct Place {
    std::filesystem::path file;
    CaptureTime time{};
    friend bool operator==(const Place&, const Place&) = default;
  };

  static constexpr std::size_t kMaxRuns = 4096;
  /// Places that are known of each stream. At 40 Hz, this many of 32 frames each are an hour; then
  /// every second one is forgotten.
  static constexpr std::size_t kMaxPlaces = 4096;

  /// The frames that follow are in this file.
  void BeginFile(const std::filesystem::path& file);
  /// The recording has this frame. Numbers of one stream rise; one that does not is left out.
  void Add(Sensor sensor, std::uint64_t number, CaptureTime time) {
    Add(sensor, FrameRange{number, number}, time);
  }
  /// The same for frames in a row, of which the first is of `time`.
  void Add(Sensor sensor, const FrameRange& frames, CaptureTime time);

  /// The recording does not have these frames after all: what it has of them cannot be read.
  void Forget(Sensor sensor, const FrameRange& frames);
  /// The same for all frames of a file from `number` on; does nothing while
  /// that is the newest, where they may still come.
  void ForgetRest(Sensor sensor, std::uint64_t number, const std::filesystem::path& file);

  /// The same for all frames of a file so far.
  void ForgetAll(Sensor sensor, const std::filesystem::path& file);

  /// The frames of a stream before `number` were recorded and are deleted; nothing is known of it
  /// yet.
  void AddDeleted(Sensor sensor, std::uint64_t number);
  /// A file of the recording is deleted to make room, the oldest that is there: none of its frames
  /// can be read any more, nor those of files before it.
  void DeleteUpTo(const std::filesystem::path& file);
  /// Returns whether a file of the recording is still there, as far as is known.
  bool HasFile(const std::filesystem::path& file) const;

  /// Returns which of the frames in `wanted`, ascending ranges, are recorded; ascending.
  std::vector<FrameRange> Of(Sensor sensor, const std::vector<FrameRange>& wanted) const;
  /// The same for those that were recorded and are deleted. Where there are more than kMaxRuns of
  /// these in a row, gaps between the oldest count as well.
  std::vector<FrameRange> DeletedOf(Sensor sensor, const std::vector<FrameRange>& wanted) const;
  /// Returns a place at or before a recorded frame, or nothing if none is known.
  std::optional<Place> PlaceOf(Sensor sensor, std::uint64_t number) const;

 private:
  /// Holds a frame whose place is known.
  struct Mark {
    std::uint64_t number = 0;
    CaptureTime time{};
    std::size_t file = 0;  ///< Its number, of all files of the recording.
  };
  struct Stream {
    std::vector<FrameRange> runs;     ///< Ascending, with gaps between them.
    std::vector<FrameRange> deleted;  ///< The same; all lie before the runs.
    std::vector<Mark> marks;          ///< Ascending.
    std::uint64_t stride = 32;        ///< Numbers between two marks.
  };
  static void AddMark(const Mark& mark, Stream& stream);
  static void Cut(const FrameRange& frames, Stream& stream);
  static void AddTo(const FrameRange& frames, std::vector<FrameRange>& deleted);
  const std::filesystem::path& FileOf(const Mark& mark) const REQUIRES(mutex_) {
    return files_[mark.file - deleted_files_];
  }

  mutable Mutex mutex_;
  std::deque<std::filesystem::path> files_ GUARDED_BY(mutex_);
  std::size_t deleted_files_ GUARDED_BY(mutex_) = 0;  ///< Before those.
  std::array<Stream, 2> streams_ GUARDED_BY(mutex_);  ///< By Sensor.
};

}  // namespace isotherm
