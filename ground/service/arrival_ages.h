#pragma once

#include <optional>
#include <string>

#include "common/base/stage_stats.h"
#include "common/frame/frame.h"
#include "ground/json/json.h"
#include "ground/subscriber/session_counters.h"

namespace isotherm {

/// Tells how old live frames were when they arrived, from capture on the rig to the ground. Two
/// computers' clocks are in that: their difference is taken off as far as it is known. Frames from
/// before it is known do not count, nor do those of a replay that keeps its own times.
/// Thread-compatible.
class ArrivalAges {
 public:
  /// Takes the newest that is known of the rig's clock.
  void SetClock(const SessionClock& clock);
  /// Takes a frame that was captured at `capture` by the rig's clock and arrived by ours.
  void Add(Sensor sensor, CaptureTime capture, CaptureTime arrival);

  /// Returns count, median and percentiles of each camera, and the most that all may be wrong by,
  /// milliseconds; null before the first frame.
  Json Describe() const;
  /// The same in a line for the operator; empty before the first frame.
  std::string ToText() const;

 private:
  struct Difference {
    double seconds =
        0.0;  ///< Ours to the rig's, steps of the rig's clock during the scan included.
    double uncertainty_s = 0.0;
  };

  std::optional<Difference> difference_;
  double largest_uncertainty_s_ = 0.0;  ///< Only the used ones count.
  StageStats depth_, thermal_;
};

}  // namespace isotherm
