#pragma once

#include <memory>
#include <variant>

#include "common/frame/frame.h"

namespace isotherm {

/// A frame behind the codec, shared by the spool and the publisher.
struct EncodedFrame {
  std::variant<EncodedDepthFrame, EncodedThermalFrame> content;
  CaptureTime arrival{};

  Sensor sensor() const {
    return std::holds_alternative<EncodedDepthFrame>(content) ? Sensor::kDepth : Sensor::kThermal;
  }
};

using EncodedFramePtr = std::shared_ptr<const EncodedFrame>;

}  // namespace isotherm
