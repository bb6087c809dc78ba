#include "edge/spool/disk_watch.h"

#include <algorithm>

#include "common/base/units.h"
#include "edge/options/edge_options.pb.h"

namespace isotherm {
namespace {

// Shorter, and one chunk more or less would count.
constexpr Nanoseconds kMeasuring = std::chrono::seconds(5);
constexpr double kQuotaMargin_s = 10.0;
constexpr double kMbPerGb = 1e3;

/// Where the newest is kept, what the disk lacks is deleted: no more than a file need be free.
double MaxReserve_mb(const SpoolOptions& options) {
  const double reserve_mb = options.expert().reserve_mb();
  return options.when_full() == KEEP_NEWEST
             ? std::min(reserve_mb, kMbPerGb * options.quota_gb() / DiskWatch::kKeptParts)
             : reserve_mb;
}

}  // namespace

DiskWatch::DiskWatch(const SpoolOptions& options)
    : max_reserve_bytes_(MaxReserve_mb(options) * kBytesPerMb),
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

DiskLevel DiskWatch::Update(SteadyTime now, const DiskSpace& space, std::uint64_t recorded_bytes,
                            bool is_ended) {
  Measure(now, recorded_bytes);
  if (bytes_per_s_ <= 0.0) {
    // A quota that is used up is so at any rate.
    is_quota_first_ = space.quota_bytes == 0;
    return is_quota_first_ ? DiskLevel::kReserve : DiskLevel::kEnough;
  }
  reserve_bytes_ = std::min(max_reserve_bytes_, reserve_s_ * bytes_per_s_);
  const double of_disk = static_cast<double>(space.free_bytes) - reserve_bytes_;
  const auto of_quota = static_cast<double>(space.quota_bytes);
  is_quota_first_ = of_quota < of_disk;
  const double usable = std::min(of_disk, of_quota);
  left_s_ = (std::max(usable, 0.0) + static_cast<double>(space.deletable_bytes)) / bytes_per_s_;
  const double needed =
      !is_ended ? 0.0
                : (is_quota_first_ ? std::min(reserve_bytes_, kQuotaMargin_s * bytes_per_s_)
                                   : reserve_bytes_);
  if (usable <= 0.0 || usable < needed) return DiskLevel::kReserve;
  return left_s_ < warn_s_ ? DiskLevel::kLow : DiskLevel::kEnough;
}

}  // namespace isotherm
