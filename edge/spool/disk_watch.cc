#include "edge/spool/disk_watch.h"

#include <algorithm>

#include "common/base/units.h"
#include "edge/options/edge_options.pb.h"

namespace isotherm {
namespace {

// Shorter, and one chunk more or less would count.
constexpr Nanoseconds kMeasuring = std::chrono::seconds(5);

}  // namespace

DiskWatch::DiskWatch(const SpoolOptions& options)
    : max_reserve_bytes_(options.expert().reserve_mb() * kBytesPerMb),
      reserve_s_(options.expert().reserve_s()),
      warn_s_(options.expert().warn_s()) {}

void DiskWatch::Measure(SteadyTime now, std::uint64_t recorded_bytes) {
  if (!mark_ || recorded_bytes < mark_->bytes) mark_ = {now, recorded_bytes};
  if (now - mark_->time < kMeasuring) return;
  const double rate =
      static_cast<double>(recorded_bytes - mark_->bytes) / ToSeconds(now - mark_->time);
  // A pause of the cameras says nothing about what comes after it.
  if (rate > 0.0) bytes_per_s_ = bytes_per_s_ > 0.0 ? 0.5 * (bytes_per_s_ + rate) : rate;
  mark_ = {now, recorded_bytes};
}

DiskLevel DiskWatch::Update(SteadyTime now, std::uint64_t free_bytes,
                            std::uint64_t recorded_bytes) {
  Measure(now, recorded_bytes);
  if (bytes_per_s_ <= 0.0) return level_;
  reserve_bytes_ = std::min(max_reserve_bytes_, reserve_s_ * bytes_per_s_);
  const double usable = static_cast<double>(free_bytes) - reserve_bytes_;
  left_s_ = std::max(usable, 0.0) / bytes_per_s_;
  const bool stays = level_ == DiskLevel::kReserve && usable < reserve_bytes_;
  if (usable <= 0.0 || stays) {
    level_ = DiskLevel::kReserve;
  } else {
    level_ = left_s_ < warn_s_ ? DiskLevel::kLow : DiskLevel::kEnough;
  }
  return level_;
}

}  // namespace isotherm
