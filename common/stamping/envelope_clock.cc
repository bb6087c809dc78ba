#include "common/stamping/envelope_clock.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "common/base/check.h"

namespace isotherm {
namespace {

// How fast the estimate may move until it has caught up with the line for the first time: half a
// percent, a third of a millisecond from frame to frame.
constexpr double kCatchUpSlew = 5e-3;
// Caught up.
constexpr double kClose_s = 20e-6;
// The line touches two samples. The gap below the fifth lowest is about as wide as the line is
// uncertain, whatever the shape of the jitter (docs/timing.md has the check).
constexpr std::size_t kGapRank = 4;

}  // namespace

EnvelopeClock::EnvelopeClock(const EnvelopeOptions& options)
    : options_(options), median_(static_cast<std::size_t>(options.median_window)) {
  CHECK(options.median_window >= 1);
  CHECK(options.window_s > 0.0);
}

Stamp EnvelopeClock::Process(DeviceTicks ticks, CaptureTime arrival) {
  if (last_ticks_ && IsFromAnotherCounter(ticks, arrival)) {
    ++resets_;
    Restart();
  }
  if (!last_ticks_) {
    first_ticks_ = ticks;
    first_arrival_ = arrival;
  }
  last_ticks_ = ticks;
  const Sample sample = Relative(ticks, arrival);
  Add(sample);
  if (!warm_) return WarmUp(sample.time_s);
  Follow(sample.time_s);
  const Stamp stamp = MakeStamp(sample.time_s);
  WatchResidual(stamp.synchronised, sample.time_s);
  return stamp;
}

bool EnvelopeClock::IsFromAnotherCounter(DeviceTicks ticks, CaptureTime arrival) const {
  if (ticks < *last_ticks_) return true;
  if (!warm_) return false;
  const Sample sample = Relative(ticks, arrival);
  return sample.difference_s < line_.At(sample.time_s) - options_.early_limit_s;
}

EnvelopeClock::Sample EnvelopeClock::Relative(DeviceTicks ticks, CaptureTime arrival) const {
  const Nanoseconds device = ticks - first_ticks_;
  return {.time_s = ToSeconds(device),
          .difference_s = ToSeconds(arrival - first_arrival_ - device)};
}

void EnvelopeClock::Restart() {
  last_ticks_.reset();
  samples_.clear();
  hull_ = {};
  next_hull_ = {};
  median_.Clear();
  off_since_s_.reset();
  warm_ = false;
  caught_up_ = false;
}

void EnvelopeClock::Add(const Sample& sample) {
  samples_.push_back(sample);
  median_.Add(FromSeconds(sample.difference_s));
  const LowerHull::Point point{.x = sample.time_s, .y = sample.difference_s};
  hull_.Add(point);
  // Turns are taken when the younger hull has seen a whole window.
  if (!next_hull_.empty() && sample.time_s - next_hull_.first_x() >= options_.window_s) {
    hull_ = std::exchange(next_hull_, {});
    hull_.Add(point);
    while (samples_.front().time_s < hull_.first_x()) samples_.pop_front();
  }
  if (sample.time_s - hull_.first_x() >= options_.window_s) next_hull_.Add(point);
}

Stamp EnvelopeClock::WarmUp(double now_s) {
  const double median_s = ToSeconds(median_.Median());
  estimate_s_ = median_s - median_excess_s_;
  estimated_at_s_ = now_s;
  warm_ = samples_.size() >= static_cast<std::size_t>(options_.median_window);
  Stamp stamp{.time = StampTime(now_s), .sigma = median_.Sigma()};
  if (samples_.size() > 1 && median_excess_s_ == 0.0) {
    // The median is above the line by something that is not known yet.
    const auto lowest = std::min_element(
        samples_.begin(), samples_.end(),
        [](const Sample& a, const Sample& b) { return a.difference_s < b.difference_s; });
    stamp.sigma = FromSeconds(std::hypot(ToSeconds(stamp.sigma), median_s - lowest->difference_s));
  }
  return stamp;
}

void EnvelopeClock::Follow(double now_s) {
  line_ = hull_.Below((hull_.first_x() + now_s) / 2.0, 1e-6 * options_.max_skew_ppm);
  const double elapsed_s = now_s - estimated_at_s_;
  const double expected_s = estimate_s_ + line_.slope * elapsed_s;
  const double limit_s = elapsed_s * (caught_up_ ? 1e-6 * options_.max_slew_ppm : kCatchUpSlew);
  const double behind_s = line_.At(now_s) - expected_s;
  estimate_s_ = expected_s + std::clamp(behind_s, -limit_s, limit_s);
  estimated_at_s_ = now_s;
  caught_up_ = caught_up_ || std::abs(line_.At(now_s) - estimate_s_) < kClose_s;
  if (caught_up_) median_excess_s_ = ToSeconds(median_.Median()) - line_.At(now_s);
}

Stamp EnvelopeClock::MakeStamp(double now_s) const {
  Stamp stamp{.time = StampTime(now_s)};
  const double floor_s = Floor(now_s);
  stamp.synchronised = floor_s < options_.residual_limit_s;
  stamp.sigma = FromSeconds(std::max(Sigma(now_s), stamp.synchronised ? 0.0 : floor_s));
  return stamp;
}

CaptureTime EnvelopeClock::StampTime(double now_s) const {
  return first_arrival_ + FromSeconds(now_s) + FromSeconds(estimate_s_);
}

void EnvelopeClock::WatchResidual(bool synchronised, double now_s) {
  if (synchronised) {
    off_since_s_.reset();
    return;
  }
  if (!off_since_s_) off_since_s_ = now_s;
  if (now_s - *off_since_s_ < options_.relearn_after_s) return;
  ++relearned_;
  median_excess_s_ = 0.0;  // Measured against a line that was wrong.
  Restart();
}

double EnvelopeClock::Floor(double now_s) const {
  const double from_s = now_s - options_.residual_window_s;
  if (samples_.front().time_s > from_s) return 0.0;
  double floor_s = std::numeric_limits<double>::infinity();
  for (auto sample = samples_.rbegin(); sample != samples_.rend(); ++sample) {
    if (sample->time_s < from_s) break;
    floor_s = std::min(floor_s, sample->difference_s - line_.At(sample->time_s));
  }
  return floor_s;
}

double EnvelopeClock::Sigma(double now_s) const {
  std::array<double, kGapRank + 1> lowest_s;
  lowest_s.fill(std::numeric_limits<double>::infinity());
  for (const Sample& sample : samples_) {
    const double excess_s = sample.difference_s - line_.At(sample.time_s);
    if (excess_s >= lowest_s.back()) continue;
    const auto place = std::upper_bound(lowest_s.begin(), lowest_s.end(), excess_s);
    std::move_backward(place, lowest_s.end() - 1, lowest_s.end());
    *place = excess_s;
  }
  const std::size_t rank = std::min(kGapRank, samples_.size() - 1);
  const double behind_s = line_.At(now_s) - estimate_s_;
  return std::hypot(ToSeconds(kTickResolution), lowest_s[rank], behind_s);
}

}  // namespace isotherm
