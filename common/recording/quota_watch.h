#pragma once

#include <algorithm>
#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <utility>

#include "common/time/time_types.h"

namespace isotherm {

/// Tells what is left of a quota: asks from time to time what everything takes, and adds what was
/// written since. Thread-compatible.
class QuotaWatch {
 public:
  static constexpr std::uint64_t kNoQuota = std::numeric_limits<std::uint64_t>::max();
  static constexpr double kBytesPerGb = 1e9;
  /// Says what counts takes on the disk, bytes; nullopt if that cannot be found out now.
  using Size = std::function<std::optional<std::uint64_t>()>;
  /// Other hands than the caller's only delete. Shorter: large folders are read through too often.
  static constexpr Nanoseconds kInterval = std::chrono::seconds(10);

  /// `quota_gb` in 1e9 bytes; 0 = none.
  QuotaWatch(double quota_gb, Size size)
      : quota_bytes_(static_cast<std::uint64_t>(quota_gb * kBytesPerGb)), size_(std::move(size)) {}

  /// Returns how many bytes are left; kNoQuota without one. `written`: what the caller has written
  /// so far, bytes.
  std::uint64_t Left(SteadyTime now, std::uint64_t written) {
    if (quota_bytes_ == 0 || !size_) return kNoQuota;
    if (now >= due_ || written < written_then_) {
      written_then_ = std::min(written_then_, written);
      due_ = now + kInterval;
      if (const std::optional<std::uint64_t> size = size_()) {
        size_then_ = *size;
        written_then_ = written;
      }
    }
    // The newest chunk may have been counted already, or not yet; that is little.
    const std::uint64_t used = size_then_ + (written - written_then_);
    return used < quota_bytes_ ? quota_bytes_ - used : 0;
  }
  /// Something was deleted.
  void AskAgain() { due_ = {}; }

 private:
  const std::uint64_t quota_bytes_;
  const Size size_;
  SteadyTime due_{};
  std::uint64_t size_then_ = 0;  ///< When it was asked for last.
  std::uint64_t written_then_ = 0;
};

}  // namespace isotherm
