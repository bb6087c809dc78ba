#include "common/stamping/envelope_clock.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace isotherm {
namespace {

// How fast the estimate may move until it has caught up with the line for the first time: half a
// percent, a third of a millisecond from frame to frame.
constexpr double kCatchUpSlew = 5e-3;
// Caught up: this close to a line that rests on this many groups (ten seconds).
constexpr double kClose_s = 20e-6;
constexpr std::size_t kSettledGroups = 20;

}  // namespace

EnvelopeClock::EnvelopeClock(const EnvelopeOptions& options)
    : options_(options),
      line_(static_cast<std::size_t>(options.median_window), options.window_s,
            1e-6 * options.max_skew_ppm),
      median_(static_cast<std::size_t>(options.median_window)) {}

Stamp EnvelopeClock::Process(DeviceTicks ticks, CaptureTime arrival) {
  // A camera that was plugged in again counts from another zero, which would tear the line.
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
  const bool was_warm = warm();
  Add(sample);
  if (!was_warm) return WarmUp(sample.x);
  Follow(sample.x);
  const Stamp stamp = MakeStamp(sample.x);
  WatchResidual(stamp.synchronised, sample.x);
  return stamp;
}

bool EnvelopeClock::IsFromAnotherCounter(DeviceTicks ticks, CaptureTime arrival) const {
  if (ticks < *last_ticks_) return true;
  if (!warm()) return false;
  const Sample sample = Relative(ticks, arrival);
  // A frame cannot arrive before it was captured: one far below the line is of another counter.
  return sample.y < line_.At(sample.x) - options_.early_limit_s;
}

void EnvelopeClock::BeginCounter() {
  if (!last_ticks_) return;
  ++resets_;
  Restart();
}

EnvelopeClock::Sample EnvelopeClock::Relative(DeviceTicks ticks, CaptureTime arrival) const {
  const Nanoseconds device = ticks - first_ticks_;
  // Relative to the first frame: doubles of seconds since 1970 resolve no microseconds.
  return {.x = ToSeconds(device), .y = ToSeconds(arrival - first_arrival_ - device)};
}

void EnvelopeClock::Restart() {
  last_ticks_.reset();
  recent_.clear();
  line_.Clear();
  median_.Clear();
  off_since_s_.reset();
  caught_up_ = false;
}

void EnvelopeClock::Add(const Sample& sample) {
  line_.Add(sample);
  median_.Add(FromSeconds(sample.y));
  recent_.push_back(sample);
  // One sample before the window stays, so that Floor() knows whether the window is full.
  while (recent_[1 < recent_.size() ? 1 : 0].x < sample.x - options_.residual_window_s)
    recent_.pop_front();
}

Stamp EnvelopeClock::WarmUp(double now_s) {
  const double median_s = ToSeconds(median_.Median());
  // After a restart the excess is known from before.
  estimate_s_ = median_s - median_excess_s_;
  estimated_at_s_ = now_s;
  Stamp stamp{.time = StampTime(now_s), .sigma = median_.Sigma()};
  if (recent_.size() > 1 && median_excess_s_ == 0.0) {
    // The median is above the line by something that is not known yet.
    const double lowest_s = std::ranges::min_element(recent_, {}, &Sample::y)->y;
    stamp.sigma = FromSeconds(std::hypot(ToSeconds(stamp.sigma), median_s - lowest_s));
  }
  return stamp;
}

void EnvelopeClock::Follow(double now_s) {
  const double elapsed_s = now_s - estimated_at_s_;
  const double expected_s = estimate_s_ + line_.slope() * elapsed_s;
  const double limit_s = elapsed_s * (caught_up_ ? 1e-6 * options_.max_slew_ppm : kCatchUpSlew);
  const double behind_s = line_.At(now_s) - expected_s;
  // Stamps must not jump when the line is fitted anew: intervals between frames would be wrong, and
  // the tracker uses them.
  estimate_s_ = expected_s + std::clamp(behind_s, -limit_s, limit_s);
  estimated_at_s_ = now_s;
  caught_up_ = caught_up_ || (line_.groups() >= kSettledGroups &&
                              std::abs(line_.At(now_s) - estimate_s_) < kClose_s);
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
  if (recent_.front().x > from_s) return 0.0;
  double floor_s = std::numeric_limits<double>::infinity();
  for (const Sample& sample : recent_) {
    if (sample.x >= from_s) floor_s = std::min(floor_s, sample.y - line_.At(sample.x));
  }
  return floor_s;
}

double EnvelopeClock::Sigma(double now_s) const {
  const double behind_s = line_.At(now_s) - estimate_s_;
  return std::hypot(ToSeconds(kTickResolution), line_.Sigma(now_s), behind_s);
}

}  // namespace isotherm
