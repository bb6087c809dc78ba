#pragma once

#include <deque>
#include <optional>

#include "common/frame/frame.h"

namespace isotherm {

class NucOptions;

/// Follows the warm-up of a thermal camera (thesis 3.2.3): it is warm when the temperature of its
/// detector changes more slowly than an option says, measured over a time that is an option too. A
/// camera that does not tell its detector's temperature is assessed by its housing's; one that
/// tells neither is warm so many seconds after the first frame. Once warm, it stays so: what
/// changes later is drift. Thread-compatible.
class WarmUpWatch {
 public:
  enum class State {
    kNotAssessed,  ///< Watched for too short a time.
    kCold,         ///< Still changing, or the time is not over.
    kWarm,
  };

  explicit WarmUpWatch(const NucOptions& options);

  /// `time` must not decrease between calls.
  State Update(CaptureTime time, const ThermalHousekeeping& housekeeping);

  /// Change of the temperature, kelvin per minute; nullopt = not known (yet).
  std::optional<double> rate_k_per_min() const { return rate_k_per_min_; }
  /// Returns what a camera without temperatures still needs.
  Nanoseconds left() const { return left_; }

 private:
  struct Sample {
    CaptureTime time;
    double celsius;
  };
  State Assess(CaptureTime time, double celsius);

  const double limit_k_per_min_;
  const Nanoseconds window_;
  const Nanoseconds blind_;  ///< For cameras that tell no temperature.
  std::optional<CaptureTime> start_;
  std::deque<Sample> samples_;  ///< About one a second, over the window.
  std::optional<double> rate_k_per_min_;
  Nanoseconds left_{0};
  State state_ = State::kNotAssessed;
};

}  // namespace isotherm
