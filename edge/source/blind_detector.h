#pragma once

#include <optional>

#include "common/frame/frame.h"
#include "common/time/time_types.h"

namespace isotherm {

class FrameCheckOptions;

/// Decides whether the depth camera is blind: covered, or everything is too close or too far. It is
/// when the fraction of pixels with a return stays below a limit for a while, and sees again with
/// the first frame above it. Pure. Thread-compatible.
class BlindDetector {
 public:
  explicit BlindDetector(const FrameCheckOptions& options);

  /// Returns whether the camera is blind as of `frame`, whose arrival must not be before the last
  /// one's.
  bool Update(const RawFrame& frame);

 private:
  const double min_valid_ratio_;
  const Nanoseconds blind_after_;
  std::optional<CaptureTime> dark_since_;
};

/// The fraction of pixels with a return, 0..1; 0 of an image without pixels.
double ValidRatio(const Image<std::uint16_t>& depth_raw);

}  // namespace isotherm
