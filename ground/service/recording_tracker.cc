#include "ground/service/recording_tracker.h"

#include <fmt/format.h>

#include <algorithm>

#include "common/base/units.h"

namespace isotherm {

namespace {

constexpr EnumArray<NotRecorded, std::string_view> kNames = {
    {NotRecorded::kDiskTooSlow, "disk_too_slow"},
    {NotRecorded::kDiskNearlyFull, "disk_nearly_full"},
    {NotRecorded::kDiskFailed, "disk_failed"},
    {NotRecorded::kUnwritable, "unwritable"}};

}  // namespace

std::string_view ToString(NotRecorded reason) { return kNames[reason]; }

std::uint64_t Sum(const NotRecordedCounts& counts) {
  std::uint64_t sum = 0;
  for (const NotRecorded reason : AllValues<NotRecorded>()) sum += counts[reason];
  return sum;
}

std::uint64_t RecordingProgress::left_out() const {
  return Sum(depth_left_out) + Sum(thermal_left_out);
}

std::uint64_t RecordingProgress::left_out(NotRecorded reason) const {
  return depth_left_out[reason] + thermal_left_out[reason];
}

std::string DiskText(const RecordingProgress& progress) {
  constexpr double kMinutesPerHour = 60.0;
  if (progress.path.empty() || progress.closed || !(progress.bytes_per_s > 0.0)) return {};
  const std::uint64_t usable =
      progress.free_bytes - std::min(progress.free_bytes, progress.reserve_bytes);
  const double minutes = static_cast<double>(usable) / progress.bytes_per_s / kSPerMin;
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
  ++counts[reason];
}

}  // namespace isotherm
