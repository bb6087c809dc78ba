#include "common/stamping/median_clock.h"

#include <algorithm>
#include <cmath>

#include "common/base/check.h"

namespace isotherm {
namespace {

// Standard deviation of normal noise per median absolute deviation, and of the median of n samples
// per standard deviation of one (asymptotic: sqrt(pi / 2 / n)).
constexpr double kSigmaPerMad = 1.4826;
constexpr double kMedianEfficiency = 1.2533;

Nanoseconds MedianOfSorted(const std::vector<Nanoseconds>& sorted) {
  const std::size_t middle = sorted.size() / 2;
  if (sorted.size() % 2 == 1) return sorted[middle];
  // Not the sum of both over two, which could overflow.
  return sorted[middle - 1] + (sorted[middle] - sorted[middle - 1]) / 2;
}

}  // namespace

void SlidingMedian::Add(Nanoseconds value) {
  if (values_.size() == window_) {
    sorted_.erase(std::lower_bound(sorted_.begin(), sorted_.end(), values_.front()));
    values_.pop_front();
  }
  values_.push_back(value);
  sorted_.insert(std::upper_bound(sorted_.begin(), sorted_.end(), value), value);
}

void SlidingMedian::Clear() {
  values_.clear();
  sorted_.clear();
}

Nanoseconds SlidingMedian::Median() const {
  CHECK(!sorted_.empty());
  return MedianOfSorted(sorted_);
}

Nanoseconds SlidingMedian::Sigma() const {
  if (sorted_.size() < 2) return Nanoseconds(0);
  const Nanoseconds median = Median();
  std::vector<Nanoseconds> deviations;
  deviations.reserve(sorted_.size());
  for (const Nanoseconds value : sorted_) deviations.push_back(std::chrono::abs(value - median));
  std::sort(deviations.begin(), deviations.end());
  const double spread_ns = kSigmaPerMad * static_cast<double>(MedianOfSorted(deviations).count());
  const double sigma_ns =
      kMedianEfficiency * spread_ns / std::sqrt(static_cast<double>(sorted_.size()));
  // A quiet computer may show no spread at all, which does not make ticks exact.
  return std::max(kTickResolution, Nanoseconds(std::llround(sigma_ns)));
}

MedianClock::MedianClock(int window) : differences_(static_cast<std::size_t>(window)) {
  CHECK(window >= 1);
}

void MedianClock::BeginCounter() {
  if (!last_ticks_) return;
  last_ticks_.reset();
  differences_.Clear();
  ++resets_;
}

Stamp MedianClock::Process(DeviceTicks ticks, CaptureTime arrival) {
  // A counter that goes back is another one.
  if (last_ticks_ && ticks < *last_ticks_) BeginCounter();
  last_ticks_ = ticks;

  const Nanoseconds device_time = ticks.time_since_epoch();
  differences_.Add(arrival.time_since_epoch() - device_time);                         // (5.4a)
  const Nanoseconds median = differences_.Median();                                   // (5.4b)
  return {.time = CaptureTime(device_time + median), .sigma = differences_.Sigma()};  // (5.4c)
}

}  // namespace isotherm
