#pragma once

#include <cstdint>

#include "common/time/time_types.h"

namespace isotherm {

class ClockOptions;

/// The three times of a simulated frame.
struct SimulatedFrameTime {
  CaptureTime exposure;      ///< True middle of the exposure.
  DeviceTicks device_ticks;  ///< The camera's counter at that moment.
  CaptureTime arrival;       ///< When the frame reached the computer.
};

/// Simulates a camera's free-running counter and the transport of its frames to the computer
/// (thesis 5.3): offset and drift of the counter; constant delay, jitter and impulses of the
/// arrival. Exposures are equidistant in the camera's own time. Thread-compatible.
class SimulatedClock {
 public:
  /// The first exposure is at `first_exposure`, the following every 1 / `rate_hz` by the camera's
  /// clock, which read `offset_s` at `start`.
  SimulatedClock(const ClockOptions& options, double rate_hz, CaptureTime start,
                 CaptureTime first_exposure, std::uint64_t noise_stream);

  SimulatedFrameTime Next();

 private:
  const double rate_hz_;
  const CaptureTime start_;
  const CaptureTime first_exposure_;
  const std::uint64_t noise_stream_;
  const double offset_s_, drift_, delay_s_, jitter_s_, impulse_fraction_, impulse_max_s_;
  const std::uint64_t wrap_us_;
  std::uint64_t index_ = 0;
  CaptureTime last_arrival_{};
};

}  // namespace isotherm
