#include "ground/service/recording_tracker.h"

#include <algorithm>
#include <cmath>
#include <limits>

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

std::vector<std::filesystem::path> RecordingProgress::AllFiles() const {
  std::vector<std::filesystem::path> all = earlier_files;
  all.insert(all.end(), files.begin(), files.end());
  all.insert(all.end(), late_files.begin(), late_files.end());
  return all;
}

std::uint64_t RecordingProgress::left_out() const {
  return Sum(depth_left_out) + Sum(thermal_left_out);
}

std::uint64_t RecordingProgress::left_out(NotRecorded reason) const {
  return depth_left_out[reason] + thermal_left_out[reason];
}

double RecordingProgress::left_s() const {
  if (!(bytes_per_s > 0.0)) return std::numeric_limits<double>::quiet_NaN();
  return static_cast<double>(free_bytes - std::min(free_bytes, reserve_bytes)) / bytes_per_s;
}

std::string DiskText(const RecordingProgress& progress) {
  const double left_s = progress.left_s();
  if (progress.path.empty() || progress.closed || std::isnan(left_s)) return {};
  return DiskTimeText(left_s);
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
