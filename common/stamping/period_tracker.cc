#include "common/stamping/period_tracker.h"

#include <algorithm>
#include <cmath>

namespace isotherm {
namespace {

constexpr Nanoseconds kLongestGap = std::chrono::seconds(2);
// The median of the first intervals is this close to the period, even with milliseconds of jitter.
constexpr double kMaxPeriodError_ppm = 50'000.0;
constexpr int kSigmaFactor = 2;

}  // namespace

PeriodTracker::PeriodTracker(const EnvelopeOptions& options) : options_(options) {}

Stamp PeriodTracker::Process(std::uint64_t frame_number, CaptureTime arrival) {
  const Nanoseconds interval = arrival - last_arrival_;
  if (!started_ || interval > kLongestGap || frame_number <= last_number_) {
    Restart(frame_number, arrival);
    return {.time = arrival};
  }
  const auto periods = static_cast<std::int64_t>(frame_number - last_number_);
  last_number_ = frame_number;
  last_arrival_ = arrival;
  if (!clock_) return WarmUp(arrival, interval / periods);

  const double period_s = period_s_ * (1.0 + 1e-6 * clock_->skew_ppm());
  counted_ += static_cast<double>(periods);
  const double early_s = ToSeconds(last_stamp_ - arrival) + static_cast<double>(periods) * period_s;
  if (clock_->warm() && early_s > 0.5 * period_s) {
    // What was counted too often makes earlier frames look early, too.
    BeginClock();
    ++slips_;
  }
  Stamp stamp = clock_->Process(CountedTicks(), arrival);
  if (!stamp.synchronised) {
    counted_ += std::round(ToSeconds(stamp.sigma) / period_s);
    ++slips_;
  }
  last_stamp_ = stamp.time;
  stamp.sigma *= kSigmaFactor;
  const Nanoseconds late = arrival - stamp.time;
  if (late > FromSeconds(0.5 * period_s)) stamp.sigma = std::max(stamp.sigma, late);
  return stamp;
}

void PeriodTracker::Restart(std::uint64_t frame_number, CaptureTime arrival) {
  if (started_) ++slips_;
  started_ = true;
  last_number_ = frame_number;
  last_arrival_ = arrival;
  intervals_.Clear();
  clock_.reset();
  counted_ = 0.0;
}

Stamp PeriodTracker::WarmUp(CaptureTime arrival, Nanoseconds interval) {
  intervals_.Add(interval);
  // One arrival is as uncertain as an interval.
  const double sigma_s = ToSeconds(intervals_.Sigma()) * std::sqrt(double(intervals_.size()));
  if (intervals_.size() == kWarmUpFrames) {
    period_s_ = ToSeconds(intervals_.Median());
    BeginClock();
  }
  last_stamp_ = arrival;
  return {.time = arrival, .sigma = FromSeconds(sigma_s)};
}

void PeriodTracker::BeginClock() {
  EnvelopeOptions options = options_;
  options.max_skew_ppm = kMaxPeriodError_ppm;
  options.early_limit_s = 0.5 * period_s_;
  options.residual_limit_s = 0.5 * period_s_;
  clock_.emplace(options);
  counted_ = 0.0;
}

DeviceTicks PeriodTracker::CountedTicks() const {
  return DeviceTicks(std::chrono::microseconds(std::llround(1e6 * counted_ * period_s_)));
}

}  // namespace isotherm
