#pragma once

#include <deque>
#include <optional>

#include "common/frame/frame.h"

namespace isotherm {

class NucOptions;

/// Tells how fast a temperature changes, over a window of time. Thread-compatible.
class TemperatureRate {
 public:
  explicit TemperatureRate(Nanoseconds window) : window_(window) {}

  /// `time` must not decrease between calls. One sample a second is taken.
  void Add(CaptureTime time, double celsius);
  /// Kelvin per minute; nullopt until the window is full.
  std::optional<double> k_per_min() const { return k_per_min_; }

 private:
  /// Holds a temperature that the camera reported.
  struct Sample {
    CaptureTime time;
    double celsius;
  };

  const Nanoseconds window_;
  std::deque<Sample> samples_;  ///< About one a second, over the window.
  std::optional<double> k_per_min_;
};

/// Follows the warm-up of a thermal camera (thesis 3.2.3): it is warm when its detector and its
/// housing change more slowly than options say, as far as it tells their temperatures. The detector
/// settles within minutes; the housing, whose radiation is measured with the scene's, drifts for
/// some twenty. A camera that tells neither is warm this many seconds after the first frame. Once
/// warm, it stays so: what changes later is drift. Thread-compatible.
class WarmUpWatch {
 public:
  /// Says whether the camera has warmed up.
  enum class State {
    kNotAssessed,  ///< Watched for too short a time.
    kCold,         ///< Still changing, or the time is not over.
    kWarm,
  };
  /// Says what still changes: of the two, the detector if both do.
  struct Change {
    const char* part;  ///< "detector" or "housing".
    double k_per_min;
    double limit_k_per_min;
  };

  explicit WarmUpWatch(const NucOptions& options);

  /// `time` must not decrease between calls.
  State Update(CaptureTime time, const ThermalHousekeeping& housekeeping);

  /// nullopt while nothing is known to change.
  const std::optional<Change>& change() const { return change_; }
  /// Returns what a camera without temperatures still needs.
  Nanoseconds left() const { return left_; }

 private:
  /// Watches one of the two temperatures that cameras report.
  struct Part {
    const char* name;
    const double limit_k_per_min;
    TemperatureRate rate;
    bool is_told = false;  ///< Once told, a value that is missing leaves what was known.
  };
  /// Warm if the camera does not tell the part's temperature.
  State Assess(Part& part, CaptureTime time, double celsius);

  const Nanoseconds blind_;  ///< For cameras that tell no temperature.
  Part detector_, housing_;
  std::optional<CaptureTime> start_;
  std::optional<Change> change_;
  Nanoseconds left_{0};
  State state_ = State::kNotAssessed;
};

}  // namespace isotherm
