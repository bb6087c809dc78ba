#pragma once

#include <cstdint>
#include <optional>

#include "common/base/status.h"
#include "common/frame/frame.h"
#include "common/stamping/envelope_clock.h"
#include "common/stamping/median_clock.h"
#include "common/stamping/period_tracker.h"
#include "common/stamping/stamp.h"
#include "common/time/time_types.h"

namespace isotherm {

class TimestamperOptions;

Status Validate(const TimestamperOptions& options);

/// Counts how often something had to be done about a camera's clock.
struct StampingCounts {
  std::uint64_t resets = 0;          ///< Counter reset, jumped, or given up.
  std::uint64_t moved = 0;           ///< Stamps that had to be moved to stay increasing.
  std::uint64_t unsynchronised = 0;  ///< Frames whose sigma says that they must not be fused.
};

/// Gives the frames of one camera their capture time: what the chosen estimator makes of ticks and
/// arrival (docs/timing.md), plus a constant delay (Ordonez Müller, *Close range 3D thermography*,
/// eq. 5.5). Stamps strictly increase; what would not is moved 1 ns behind the stamp before and
/// counted. Pure: no clock inside. Thread-compatible.
class Timestamper {
 public:
  /// `options` must be valid (Validate). `rig_delay` comes from the calibration and is added to the
  /// configured delay of the sensor.
  Timestamper(const TimestamperOptions& options, Sensor sensor, Nanoseconds rig_delay);

  /// Stamps a frame by what the source said about it, of which nothing but the times is used.
  /// `arrival` is the frame's, freed from steps of the wall clock.
  Stamp Process(const RawFrame& frame, CaptureTime arrival);

  StampingCounts counts() const;

 private:
  const bool use_envelope_;
  const Nanoseconds constant_delay_;
  MedianClock median_;
  EnvelopeClock envelope_;
  PeriodTracker period_;
  std::optional<CaptureTime> last_stamp_;
  StampingCounts counts_;
};

}  // namespace isotherm
