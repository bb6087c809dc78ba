#include "edge/timestamper/timestamper.h"

#include <algorithm>
#include <cmath>

#include "common/base/check.h"

namespace isotherm {
namespace {

// Standard deviation of normal noise per median absolute deviation, and of the median of n samples
// per standard deviation of one (asymptotic: sqrt(pi / 2 / n)).
constexpr double kSigmaPerMad = 1.4826;
constexpr double kMedianEfficiency = 1.2533;
// Ticks have microseconds; nothing is known better than that.
constexpr Nanoseconds kResolution = std::chrono::microseconds(1);

Nanoseconds MedianOfSorted(const std::vector<Nanoseconds>& sorted) {
  const std::size_t middle = sorted.size() / 2;
  if (sorted.size() % 2 == 1) return sorted[middle];
  return sorted[middle - 1] + (sorted[middle] - sorted[middle - 1]) / 2;
}

}  // namespace

Timestamper::Timestamper(int window, Nanoseconds constant_delay)
    : window_(static_cast<std::size_t>(window)), constant_delay_(constant_delay) {
  CHECK(window >= 1);
}

Stamp Timestamper::Process(DeviceTicks ticks, CaptureTime arrival) {
  if (last_ticks_ && ticks < *last_ticks_) {
    differences_.clear();
    sorted_.clear();
    ++resets_;
  }
  last_ticks_ = ticks;

  const Nanoseconds device_time = ticks.time_since_epoch();
  AddDifference(arrival.time_since_epoch() - device_time);                          // (5.4a)
  const Nanoseconds median = Median();                                              // (5.4b)
  Stamp stamp{CaptureTime(device_time + median + constant_delay_), Sigma(median)};  // (5.4c), (5.5)

  if (last_stamp_ && stamp.time <= *last_stamp_) {
    stamp.time = *last_stamp_ + Nanoseconds(1);
    ++moved_;
  }
  last_stamp_ = stamp.time;
  return stamp;
}

void Timestamper::AddDifference(Nanoseconds difference) {
  if (differences_.size() == window_) {
    sorted_.erase(std::lower_bound(sorted_.begin(), sorted_.end(), differences_.front()));
    differences_.pop_front();
  }
  differences_.push_back(difference);
  sorted_.insert(std::upper_bound(sorted_.begin(), sorted_.end(), difference), difference);
}

Nanoseconds Timestamper::Median() const { return MedianOfSorted(sorted_); }

Nanoseconds Timestamper::Sigma(Nanoseconds median) const {
  if (sorted_.size() < 2) return Nanoseconds(0);
  std::vector<Nanoseconds> deviations;
  deviations.reserve(sorted_.size());
  for (const Nanoseconds difference : sorted_)
    deviations.push_back(std::chrono::abs(difference - median));
  std::sort(deviations.begin(), deviations.end());
  const double spread_ns = kSigmaPerMad * static_cast<double>(MedianOfSorted(deviations).count());
  const double sigma_ns =
      kMedianEfficiency * spread_ns / std::sqrt(static_cast<double>(sorted_.size()));
  return std::max(kResolution, Nanoseconds(std::llround(sigma_ns)));
}

}  // namespace isotherm
