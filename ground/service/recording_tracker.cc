#include "ground/service/recording_tracker.h"

#include <algorithm>

#include "common/recording/disk_time.h"

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
  if (progress.path.empty() || progress.closed || !(progress.bytes_per_s > 0.0)) return {};
  const std::uint64_t usable =
      progress.free_bytes - std::min(progress.free_bytes, progress.reserve_bytes);
  return DiskTimeText(static_cast<double>(usable) / progress.bytes_per_s);
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
