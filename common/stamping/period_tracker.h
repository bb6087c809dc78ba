#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "common/stamping/envelope_clock.h"
#include "common/stamping/median_clock.h"
#include "common/stamping/stamp.h"
#include "common/time/time_types.h"

namespace isotherm {

/// Stamps for a camera without a clock: its frames are taken to be equidistant, so that their count
/// is a clock, whose period and phase EnvelopeClock finds.
///
///   warm-up   the period is estimated from the first frames; stamps are the arrivals
///   lost      holes in `frame_number` are periods that passed. Frames that were lost unseen show
///             as arrivals that all stay late: after two seconds the count is put right. Until
///             then their sigma is what they are late by
///   early     more than half a period before it was expected: the count was wrong and starts
///             again; with the period, if that was not yet certain
///   gap       longer than two seconds, or frame numbers that do not increase: starts again
///
/// The sigma is twice that of EnvelopeClock, because nobody promised that frames are equidistant.
/// Pure: no clock inside. Thread-compatible.
class PeriodTracker {
 public:
  /// `options` as for EnvelopeClock; its limits of skew and residual follow from the period.
  explicit PeriodTracker(const EnvelopeOptions& options);

  Stamp Process(std::uint64_t frame_number, CaptureTime arrival);

  /// Times that it started again, or put the count right.
  std::uint64_t slips() const { return slips_; }

 private:
  void Restart(std::uint64_t frame_number, CaptureTime arrival);
  Stamp WarmUp(std::uint64_t frame_number, CaptureTime arrival);
  /// Counts from 0 with the period as it is known.
  void BeginClock();
  DeviceTicks CountedTicks() const;

  /// Says when a frame arrived.
  struct Arrival {
    std::uint64_t frame_number;
    CaptureTime time;
  };

  /// Intervals whose median is the first period: a second at 30 Hz. With a jitter of milliseconds
  /// the median is then within kMaxPeriodError_ppm; fewer frames begin sooner and slip more often.
  /// Not tuned.
  static constexpr std::size_t kWarmUpFrames = 32;
  const EnvelopeOptions options_;
  SlidingMedian intervals_{kWarmUpFrames};
  std::vector<Arrival> warm_up_;
  std::optional<EnvelopeClock> clock_;  ///< Once the period is known.
  bool started_ = false;
  std::uint64_t last_number_ = 0;
  CaptureTime last_arrival_{};
  CaptureTime last_stamp_{};
  double period_s_ = 0.0;  ///< Nominal; what it is off by is the clock's skew.
  double counted_ = 0.0;   ///< Periods since the clock began.
  std::uint64_t slips_ = 0;
};

}  // namespace isotherm
