#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "common/frame/frame.h"
#include "common/recording/recording.h"
#include "common/time/time_types.h"

namespace isotherm {

/// A frame, and where in a recording it lies.
struct FramePlace {
  std::uint64_t number = 0;
  CaptureTime time{};
};

/// Tells what a file has of one stream.
struct StreamSurvey {
  std::uint64_t frames = 0;        ///< How many.
  std::vector<FramePlace> places;  ///< Some of them, ascending. Others may lie before the first.
  FramePlace last;
  double rate_hz = 0.0;  ///< Numbers per second at the end; 0: not known.
};

/// Finds out which frames a recording has, by samples, and exactly at the end of each stream.
/// Thread-compatible.
class RecordingSurvey {
 public:
  explicit RecordingSurvey(RecordingReader& reader);

  const StreamSurvey& Of(Sensor sensor) const {
    return streams_.at(static_cast<std::size_t>(sensor));
  }

 private:
  struct FramePoint;

  /// Returns the next frame; nullopt at the end, and where the file cannot be read.
  std::optional<FramePoint> NextFrame(int& items_left);
  /// Notes the first frame of each stream from `time` on.
  void AddPlaces(CaptureTime time);
  /// Notes the last frames that lie from `from` on and not behind `to`.
  void NoteLast(CaptureTime from, CaptureTime to);
  void SetRate(StreamSurvey& stream) const;

  RecordingReader& reader_;
  std::array<StreamSurvey, 2> streams_;  ///< By Sensor.
};

}  // namespace isotherm
