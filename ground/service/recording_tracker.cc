#include "ground/service/recording_tracker.h"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>

namespace isotherm {

std::string_view ToString(NotRecorded reason) {
  switch (reason) {
    case NotRecorded::kDiskTooSlow:
      return "disk_too_slow";
    case NotRecorded::kDiskNearlyFull:
      return "disk_nearly_full";
    case NotRecorded::kDiskFailed:
      return "disk_failed";
    case NotRecorded::kUnwritable:
      return "unwritable";
  }
  return "?";
}

std::uint64_t RecordingProgress::left_out() const {
  const auto sum = [](const NotRecordedCounts& counts) {
    return std::accumulate(counts.begin(), counts.end(), std::uint64_t{0});
  };
  return sum(depth_left_out) + sum(thermal_left_out);
}

std::uint64_t RecordingProgress::left_out(NotRecorded reason) const {
  const auto i = static_cast<std::size_t>(reason);
  return depth_left_out[i] + thermal_left_out[i];
}

std::string DiskText(const RecordingProgress& progress) {
  constexpr double kSecondsPerMinute = 60.0;
  constexpr double kMinutesPerHour = 60.0;
  if (progress.path.empty() || progress.closed || !(progress.bytes_per_s > 0.0)) return {};
  const std::uint64_t usable =
      progress.free_bytes - std::min(progress.free_bytes, progress.reserve_bytes);
  const double minutes = static_cast<double>(usable) / progress.bytes_per_s / kSecondsPerMinute;
  if (minutes < 2.0 * kMinutesPerHour) return fmt::format("disk: {:.0f} min left", minutes);
  const double hours = minutes / kMinutesPerHour;
  return hours < 100.0 ? fmt::format("disk: {:.0f} h left", hours) : "disk: days left";
}

RecordingProgress RecordingTracker::WaitUntilClosed(std::chrono::nanoseconds patience) const {
  MutexLock lock(mutex_);
  closed_.wait_for(lock, patience, [this]() REQUIRES(mutex_) { return progress_.closed; });
  return progress_;
}

void RecordingTracker::CountLeftOut(Sensor sensor, NotRecorded reason) {
  MutexLock lock(mutex_);
  NotRecordedCounts& counts =
      sensor == Sensor::kDepth ? progress_.depth_left_out : progress_.thermal_left_out;
  ++counts[static_cast<std::size_t>(reason)];
}

}  // namespace isotherm
