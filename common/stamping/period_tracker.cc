#include "common/stamping/period_tracker.h"

#include <algorithm>
#include <cmath>

#include "common/base/quantile.h"

namespace isotherm {
namespace {

/// After a longer pause the period counted on may be off by a frame: it begins anew.
constexpr Nanoseconds kMaxFrameGap = std::chrono::seconds(2);
// The first estimate of the period is this close, even with milliseconds of jitter.
constexpr double kMaxPeriodError_ppm = 50'000.0;
constexpr int kSigmaFactor = 2;

}  // namespace

PeriodTracker::PeriodTracker(const EnvelopeOptions& options) : options_(options) {}

Stamp PeriodTracker::Process(std::uint64_t frame_number, CaptureTime arrival) {
  const Nanoseconds interval = arrival - last_arrival_;
  if (!started_ || interval > kMaxFrameGap || frame_number <= last_number_) {
    Restart(frame_number, arrival);
    return {.time = arrival};
  }
  const auto periods = static_cast<std::int64_t>(frame_number - last_number_);
  last_number_ = frame_number;
  last_arrival_ = arrival;
  if (!clock_) return WarmUp(frame_number, arrival);

  const double period_s = period_s_ * (1.0 + 1e-6 * clock_->skew_ppm());
  counted_ += static_cast<double>(periods);
  const double early_s = ToSeconds(last_stamp_ - arrival) + static_cast<double>(periods) * period_s;
  if (clock_->warm() && early_s > 0.5 * period_s) {
    if (!clock_->settled()) {
      // The period itself was wrong.
      Restart(frame_number, arrival);
      return {.time = arrival};
    }
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
  warm_up_.assign(1, {frame_number, arrival});
  clock_.reset();
  counted_ = 0.0;
}

Stamp PeriodTracker::WarmUp(std::uint64_t frame_number, CaptureTime arrival) {
  const auto periods = [](const Arrival& from, const Arrival& to) {
    return (to.time - from.time) / static_cast<std::int64_t>(to.frame_number - from.frame_number);
  };
  const Arrival now{frame_number, arrival};
  intervals_.Add(periods(warm_up_.back(), now));
  warm_up_.push_back(now);
  // One arrival is as uncertain as an interval.
  const double sigma_s = ToSeconds(intervals_.Sigma()) * std::sqrt(double(intervals_.size()));
  if (warm_up_.size() == kWarmUpFrames) {
    // Jitter counts the less the longer the span (Theil and Sen's slope, of spans of one length).
    constexpr std::size_t kSpan = kWarmUpFrames / 2;
    std::vector<Nanoseconds> of_spans;
    for (std::size_t i = kSpan; i < warm_up_.size(); ++i)
      of_spans.push_back(periods(warm_up_[i - kSpan], warm_up_[i]));
    period_s_ = ToSeconds(TakeMedian(of_spans));
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
