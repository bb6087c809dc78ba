#include "edge/nuc/warm_up_watch.h"

#include <algorithm>
#include <cmath>

#include "common/base/units.h"
#include "edge/options/edge_options.pb.h"

namespace isotherm {
namespace {

/// Housekeeping temperatures change by fractions of a kelvin a minute, and cameras send them with
/// every frame: one a second keeps a window of minutes short. Smaller: more memory, no better rate.
constexpr Nanoseconds kSampleInterval = std::chrono::seconds(1);

}  // namespace

void TemperatureRate::Add(CaptureTime time, double celsius) {
  if (!samples_.empty() && time - samples_.back().time < kSampleInterval) return;
  samples_.push_back({time, celsius});
  // The oldest sample lies a window back, or a little more.
  while (samples_.size() > 2 && time - samples_[1].time >= window_) samples_.pop_front();
  const Nanoseconds span = time - samples_.front().time;
  if (span < window_ || span <= Nanoseconds(0)) return;
  k_per_min_ = kSPerMin * (celsius - samples_.front().celsius) / ToSeconds(span);
}

WarmUpWatch::WarmUpWatch(const NucOptions& options)
    : blind_(FromSeconds(options.expert().warm_up_time_s())),
      detector_{"detector", options.expert().warm_up_rate_k_per_min(),
                TemperatureRate(FromSeconds(options.expert().warm_up_stable_s()))},
      housing_{"housing", options.expert().warm_up_housing_rate_k_per_min(),
               TemperatureRate(FromSeconds(options.expert().warm_up_housing_stable_s()))} {}

WarmUpWatch::State WarmUpWatch::Update(CaptureTime time, const ThermalHousekeeping& housekeeping) {
  if (state_ == State::kWarm) return state_;
  if (!start_) start_ = time;
  // For good: a value that is missing once is not a camera that does not tell.
  detector_.is_told = detector_.is_told || std::isfinite(housekeeping.fpa_celsius);
  housing_.is_told = housing_.is_told || std::isfinite(housekeeping.housing_celsius);
  change_.reset();
  if (!detector_.is_told && !housing_.is_told) {
    left_ = std::max(Nanoseconds(0), blind_ - (time - *start_));
    // Without any temperature only the time since the start says something.
    state_ = left_ > Nanoseconds(0) ? State::kCold : State::kWarm;
    return state_;
  }
  left_ = Nanoseconds(0);
  const State housing = Assess(housing_, time, housekeeping.housing_celsius);
  const State detector = Assess(detector_, time, housekeeping.fpa_celsius);
  const auto either = [&](State state) { return housing == state || detector == state; };
  // A camera that was cold counts as cold until all its parts are known to be warm.
  if (either(State::kCold)) {
    state_ = State::kCold;
  } else if (!either(State::kNotAssessed)) {
    state_ = State::kWarm;
  }
  return state_;
}

WarmUpWatch::State WarmUpWatch::Assess(Part& part, CaptureTime time, double celsius) {
  if (!part.is_told) return State::kWarm;
  if (std::isfinite(celsius)) part.rate.Add(time, celsius);
  const std::optional<double> rate = part.rate.k_per_min();
  if (!rate) return State::kNotAssessed;
  if (std::abs(*rate) <= part.limit_k_per_min) return State::kWarm;
  change_ = Change{part.name, *rate, part.limit_k_per_min};
  return State::kCold;
}

}  // namespace isotherm
