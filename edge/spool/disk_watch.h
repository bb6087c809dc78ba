#pragma once

#include <cstdint>
#include <limits>
#include <optional>

#include "common/recording/quota_watch.h"
#include "common/time/time_types.h"

namespace isotherm {

class SpoolOptions;

/// Says how much room a recording has left.
enum class DiskLevel : std::uint8_t {
  kEnough,
  kLow,      ///< Within spool.expert.warn_s nothing but the reserve will be left.
  kReserve,  ///< Only the reserve is left, or the quota is used up.
};

/// Tells what a recording may still take.
struct DiskSpace {
  std::uint64_t free_bytes = 0;                      ///< On the disk.
  std::uint64_t quota_bytes = QuotaWatch::kNoQuota;  ///< Left of the quota.
  std::uint64_t deletable_bytes = 0;                 ///< Deleting older recordings adds these.
};

/// Assesses how long a recording can go on, by the space that it may take and how fast it grows.
/// The reserve is spool.expert.reserve_mb, or what is recorded in reserve_s if that is less; the
/// quota has none. Thread-compatible.
class DiskWatch {
 public:
  /// Files of a recording that keeps the newest: the more, the less is deleted at once.
  static constexpr double kKeptParts = 8.0;

  explicit DiskWatch(const SpoolOptions& options);

  /// To be called about once a second. `recorded_bytes`: of all files so far; it need not grow.
  /// `is_ended`: the recording has ended at kReserve; it stays there until there is room for
  /// another reserve, or for ten seconds within the quota, so that it does not end again at once.
  DiskLevel Update(SteadyTime now, const DiskSpace& space, std::uint64_t recorded_bytes,
                   bool is_ended);

  /// Until kReserve, with older recordings deleted; NaN = not known yet.
  double left_s() const { return left_s_; }
  /// Returns whether it is the quota that ends first, not the disk.
  bool is_quota_first() const { return is_quota_first_; }
  double reserve_bytes() const { return reserve_bytes_; }
  /// Returns how fast is recorded; 0: not known yet.
  double bytes_per_s() const { return bytes_per_s_; }

 private:
  void Measure(SteadyTime now, std::uint64_t recorded_bytes);

  const double max_reserve_bytes_;
  const double reserve_s_;
  const double warn_s_;
  /// Holds how much had been written at a time.
  struct Mark {
    SteadyTime time{};
    std::uint64_t bytes = 0;
  };
  std::optional<Mark> mark_;  ///< Where the current measurement began.
  double bytes_per_s_ = 0.0;  ///< 0 = not known yet.
  double reserve_bytes_ = 0.0;
  bool is_quota_first_ = false;
  double left_s_ = std::numeric_limits<double>::quiet_NaN();
};

}  // namespace isotherm
