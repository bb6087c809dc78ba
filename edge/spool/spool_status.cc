// Counters of the recording, and what is said of it.

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <utility>

#include "common/base/log.h"
#include "edge/options/edge_options.pb.h"
#include "edge/spool/spool.h"

namespace isotherm {

std::uint64_t Spool::NotRecorded() const {
  std::uint64_t recorded = closed_.depth_frames + closed_.thermal_frames;
  if (IsRecording()) {
    const RecordingStats stats = file_->writer->stats();
    recorded += stats.depth_frames + stats.thermal_frames;
  }
  return offered_[0] + offered_[1] - recorded;
}

void Spool::UpdateCounters() {
  // Remembered while all is well, so that the message at the end of a failure says what that
  // failure cost.
  if (problem_.ok()) not_recorded_before_ = NotRecorded();
  const RecordingStats open = IsRecording() ? file_->writer->stats() : RecordingStats();
  const auto set = [this](Sensor sensor, std::uint64_t recorded) {
    parts_.counters.Set(sensor, FrameFate::kRecorded, recorded);
    parts_.counters.Set(sensor, FrameFate::kRecordFailed,
                        offered_[static_cast<std::size_t>(sensor)] - recorded);
  };
  set(Sensor::kDepth, closed_.depth_frames + open.depth_frames);
  set(Sensor::kThermal, closed_.thermal_frames + open.thermal_frames);
}

std::string Spool::Brief() const {
  const bool is_quota = disk_.is_quota_first();
  if (at_reserve_) {
    return is_quota ? "NOT RECORDING: quota used up" : "NOT RECORDING: disk full";
  }
  if (!problem_.ok()) return IsRecording() ? "disk was failing" : "NOT RECORDING: disk fails";
  if (free_bytes_unknown_) return "free space of the disk not known";
  if (level_ != DiskLevel::kLow || KeepsNewest()) return "";
  return fmt::format("{} in {:.0f} min", is_quota ? "quota used up" : "disk full",
                     disk_.left_s() / 60.0);
}

double Spool::KeptSeconds() const {
  if (!KeepsNewest()) return 0.0;
  if (disk_.bytes_per_s() <= 0.0) return std::numeric_limits<double>::quiet_NaN();
  // The disk may have less room than is asked for.
  const double quota_bytes = parts_.options.quota_gb() * QuotaWatch::kBytesPerGb;
  double room_bytes = quota_bytes;
  if (free_bytes_ && quota_left_bytes_ != QuotaWatch::kNoQuota) {
    const double taken_bytes = quota_bytes - static_cast<double>(quota_left_bytes_);
    const double free_bytes = static_cast<double>(*free_bytes_) - disk_.reserve_bytes();
    room_bytes = std::min(quota_bytes, taken_bytes + std::max(free_bytes, 0.0));
  }
  // A part is deleted whole.
  return (1.0 - 1.0 / DiskWatch::kKeptParts) * room_bytes / disk_.bytes_per_s();
}

void Spool::WarnIfLittleIsKept() {
  constexpr double kLittle_s = 4.0;  // An outage of half of it is over before all is sent again.
  if (!KeepsNewest() || !(KeptSeconds() < kLittle_s) || std::exchange(warned_of_little_, true))
    return;
  LOG(Spool, Warning) << fmt::format(
      "only the newest {:.1f} s are kept: a larger spool.quota_gb keeps more", KeptSeconds());
}

void Spool::UpdateStatus() {
  // Bytes are this process's.
  const std::uint64_t frames = offered_[0] + offered_[1] - NotRecorded() - taken_over_;
  const double frame_bytes =
      frames > 0 ? static_cast<double>(OwnBytes()) / static_cast<double>(frames) : 0.0;
  const double left_s = KeepsNewest() ? std::numeric_limits<double>::quiet_NaN() : disk_.left_s();
  newest_status_.Set({path_, free_bytes_, left_s, problem_.message(), Brief(), at_reserve_,
                      frame_bytes, KeptSeconds()});
}

}  // namespace isotherm
