#pragma once

#include <memory>
#include <variant>
#include <vector>

#include "common/frame/frame.h"
#include "common/messages/messages.h"
#include "common/recording/recording.h"

namespace isotherm {

/// A frame behind the codec, shared by the spool and the publisher.
struct EncodedFrame {
  std::variant<EncodedDepthFrame, EncodedThermalFrame> content;
  CaptureTime arrival{};
  /// The wall clock, when the frame came, minus the time line of capture times: steps so far. 0 if
  /// capture times were not on the wall clock in the first place.
  Nanoseconds wall_minus_time{0};
  /// The odometry that came since the frame before: it travels along, so that order and back
  /// pressure are the same.
  std::vector<ExternalOdometrySample> external_odometry{};
  std::vector<RecordedLog> log{};  ///< Events since then, for the recording.

  Sensor sensor() const {
    return std::holds_alternative<EncodedDepthFrame>(content) ? Sensor::kDepth : Sensor::kThermal;
  }
};

using EncodedFramePtr = std::shared_ptr<const EncodedFrame>;

}  // namespace isotherm
