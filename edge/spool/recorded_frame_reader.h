#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <variant>

#include "common/base/status.h"
#include "common/frame/frame.h"
#include "common/recording/recording.h"
#include "common/time/time_types.h"
#include "edge/spool/recorded_frames.h"

namespace isotherm {

/// Reads frames back from a recording that may still be growing. Thread-compatible.
class RecordedFrameReader {
 public:
  using Frame = std::variant<EncodedDepthFrame, EncodedThermalFrame>;

  /// Goes to `place` of the recording as it is on the disk now.
  Status GoTo(const RecordedFrames::Place& place);
  /// Returns the next frame; nullopt where the file ended when it was opened. An error is about one
  /// message: the next call goes on behind it.
  Result<std::optional<Frame>> Next();

  /// Returns where it is: the file and the time of the frame that was read last. Nothing before the
  /// first GoTo and after an error of it.
  const std::optional<RecordedFrames::Place>& at() const { return at_; }
  void Close();

 private:
  std::unique_ptr<RecordingReader> reader_;
  std::optional<RecordedFrames::Place> at_;
};

}  // namespace isotherm
