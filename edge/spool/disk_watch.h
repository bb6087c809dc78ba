#pragma once

#include <cstdint>
#include <limits>
#include <optional>

#include "common/time/time_types.h"

namespace isotherm {

class SpoolOptions;

/// Says how much room a recording has left.
enum class DiskLevel : std::uint8_t {
  kEnough,
  kLow,      ///< Within spool.expert.warn_s the reserve will be reached.
  kReserve,  ///< Only the reserve is left.
};

/// Assesses how long a recording can go on, by the space that is free and how fast the recording
/// grows. The reserve is spool.expert.reserve_mb, or what is recorded in reserve_s if that is less.
/// At kReserve it stays until twice the reserve is free. Thread-compatible.
class DiskWatch {
 public:
  explicit DiskWatch(const SpoolOptions& options);

  /// To be called about once a second. `recorded_bytes`: of all files so far; it need not grow.
  DiskLevel Update(SteadyTime now, std::uint64_t free_bytes, std::uint64_t recorded_bytes);

  /// Until the reserve is reached; NaN = not known yet.
  double left_s() const { return left_s_; }
  double reserve_bytes() const { return reserve_bytes_; }

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
  double left_s_ = std::numeric_limits<double>::quiet_NaN();
  DiskLevel level_ = DiskLevel::kEnough;
};

}  // namespace isotherm
