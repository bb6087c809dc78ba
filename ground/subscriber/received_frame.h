#pragma once

#include <memory>

#include "common/frame/frame.h"

namespace isotherm {

/// A frame as it arrived (for the recording) and unpacked (for the reconstruction).
struct ReceivedDepth {
  DepthFramePtr frame;
  std::shared_ptr<const EncodedDepthFrame> encoded;
  CaptureTime arrival;   ///< Ground wall clock.
  CaptureTime queued{};  ///< When it was handed to the reconstruction, by the same clock.
  bool is_late = false;  ///< Came behind its place in the order.
};
/// The same for a thermal frame.
struct ReceivedThermal {
  ThermalFramePtr frame;
  std::shared_ptr<const EncodedThermalFrame> encoded;
  CaptureTime arrival;   ///< Ground wall clock.
  CaptureTime queued{};  ///< When it was handed to the reconstruction, by the same clock.
  bool is_late = false;  ///< Came behind its place in the order.
};

}  // namespace isotherm
