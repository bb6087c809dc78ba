#include "edge/nuc/warm_up_watch.h"

#include <algorithm>
#include <cmath>

#include "edge/options/edge_options.pb.h"

namespace isotherm {
namespace {

constexpr Nanoseconds kSampleInterval = std::chrono::seconds(1);
constexpr double kSecondsPerMinute = 60.0;

}  // namespace

WarmUpWatch::WarmUpWatch(const NucOptions& options)
    : limit_k_per_min_(options.expert().warm_up_rate_k_per_min()),
      window_(FromSeconds(options.expert().warm_up_stable_s())),
      blind_(FromSeconds(options.expert().warm_up_time_s())) {}

WarmUpWatch::State WarmUpWatch::Update(CaptureTime time, const ThermalHousekeeping& housekeeping) {
  if (state_ == State::kWarm) return state_;
  if (!start_) start_ = time;
  const float celsius = std::isfinite(housekeeping.fpa_celsius) ? housekeeping.fpa_celsius
                                                                : housekeeping.housing_celsius;
  if (std::isfinite(celsius)) {
    left_ = Nanoseconds(0);
    state_ = Assess(time, static_cast<double>(celsius));
    return state_;
  }
  left_ = std::max(Nanoseconds(0), blind_ - (time - *start_));
  state_ = left_ > Nanoseconds(0) ? State::kCold : State::kWarm;
  return state_;
}

WarmUpWatch::State WarmUpWatch::Assess(CaptureTime time, double celsius) {
  if (!samples_.empty() && time - samples_.back().time < kSampleInterval) return state_;
  samples_.push_back({time, celsius});
  // The oldest sample lies a window back, or a little more.
  while (samples_.size() > 2 && time - samples_[1].time >= window_) samples_.pop_front();
  const Nanoseconds span = time - samples_.front().time;
  if (span < window_ || span <= Nanoseconds(0)) return State::kNotAssessed;
  rate_k_per_min_ = kSecondsPerMinute * (celsius - samples_.front().celsius) / ToSeconds(span);
  return std::abs(*rate_k_per_min_) <= limit_k_per_min_ ? State::kWarm : State::kCold;
}

}  // namespace isotherm
