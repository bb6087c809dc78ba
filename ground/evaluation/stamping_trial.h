#pragma once

#include <array>
#include <cstdint>
#include <string_view>
#include <vector>

#include "common/time/time_types.h"

namespace isotherm {

/// Distribution of what a frame waits for beyond the shortest transport.
enum class JitterShape : std::uint8_t {
  kGamma,        ///< Shape 2: two exponential waits one after the other, e.g. transfer and wake-up.
  kExponential,  ///< One wait.
  kNormal,       ///< Both sides of a mean, cut 4 sigmas below: no frame is ever quite undisturbed.
};

/// Describes how a simulated camera's frames reach the computer: as in fig. 5.15 of the thesis,
/// after a baseline of some milliseconds with impulses of tens of milliseconds, and with load
/// bursts that hold up every frame.
struct StampingScenario {
  std::string_view name;
  JitterShape shape = JitterShape::kGamma;
  double jitter_s = 0.001;  ///< Scale of gamma or exponential, sigma of normal.
  double impulse_fraction = 0.02;
  double impulse_max_s = 0.040;
  double burst_period_s = 0.0;  ///< 0 = no bursts. The first begins half a period after the start.
  double burst_length_s = 0.0;
  double burst_least_s = 0.0;  ///< Every frame of a burst is held up by at least this.
  double burst_mean_s =
      0.0;  ///< Mean of what a frame of a burst is held up by beyond burst_least_s.
};

/// The scenarios of the table in docs/timing.md.
std::vector<StampingScenario> StampingScenarios();

/// Says what makes the stamps.
enum class StampingMethod : std::uint8_t {
  kArrival,   ///< The time of arrival.
  kMedian,    ///< MedianClock.
  kEnvelope,  ///< EnvelopeClock.
  kPeriod,    ///< PeriodTracker, which does not see the camera's clock.
};
inline constexpr std::array kStampingMethods = {StampingMethod::kArrival, StampingMethod::kMedian,
                                                StampingMethod::kEnvelope, StampingMethod::kPeriod};
std::string_view ToString(StampingMethod method);

/// Describes the simulated camera clock and how long it is stamped.
struct StampingTrialOptions {
  double rate_hz = 30.0;
  double duration_s = 120.0;  ///< Length of each run.
  double skip_s = 10.0;       ///< At its start, which does not count.
  int runs = 10;
  double max_drift_ppm = 100.0;  ///< Each run's camera clock is off by up to this.
  double wander_ppm =
      2.0;  ///< The drift itself changes by this much, with a period of five minutes.
  std::uint64_t seed = 1;
};

/// Stamps against the true exposure, less one constant delay for all runs: the method's median
/// residual in the scenario without bursts, which is what a calibration would find.
struct StampingResidual {
  double rms_s = 0.0;
  double p99_s = 0.0;  ///< 99th percentile of the absolute value.
  double worst_s = 0.0;
  double within_sigma = 0.0;    ///< Fraction of stamps whose residual is within their sigma.
  double within_3_sigma = 0.0;  ///< Fraction of stamps whose residual is within three sigmas.
  std::uint64_t stamps = 0;
};

/// Deterministic: the same numbers for the same options, everywhere.
StampingResidual RunStampingTrial(const StampingScenario& scenario, StampingMethod method,
                                  const StampingTrialOptions& options);

}  // namespace isotherm
