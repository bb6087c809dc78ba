#pragma once

#include "common/time/time_types.h"

namespace isotherm {

/// Capture time with its one-sigma uncertainty; 0 = not estimated yet.
struct Stamp {
  CaptureTime time;
  Nanoseconds sigma{0};
  /// False: the camera's clock does not run as the estimate says; sigma is as large as the
  /// disagreement.
  bool synchronised = true;
};

/// Ticks have microseconds; nothing is known better than that.
inline constexpr Nanoseconds kTickResolution = std::chrono::microseconds(1);

}  // namespace isotherm
