#pragma once

#include <optional>
#include <string>

#include "common/base/status.h"
#include "edge/nuc/nuc_notices.h"

namespace isotherm {

class NucOptions;

/// Lets the operator put corrections off for a bounded time, counted from the beginning of the hold
/// however often it is renewed. After one that put a correction off, that one comes first.
/// Times are those of frames. Thread-compatible.
class NucHold {
 public:
  /// `notices` must outlive it.
  NucHold(const NucOptions& options, NucNotices& notices);

  /// Holds from `now` on; 0 s ends a hold. Says for how long, or fails if the time is used up.
  Result<std::string> Hold(CaptureTime now, double seconds);
  /// Ends the hold when its time is over. `due`: why a correction is wanted; empty = it is not.
  void Update(CaptureTime now, const std::string& due);
  void OnCorrected() { is_used_up_ = false; }

  bool is_held() const { return until_.has_value(); }
  /// Returns how much of the hold is left; only while it is held.
  Nanoseconds left(CaptureTime now) const { return *until_ - now; }

 private:
  const double max_hold_s_;
  NucNotices& notices_;
  std::optional<CaptureTime> started_;
  std::optional<CaptureTime> until_;
  bool is_used_up_ = false;
};

}  // namespace isotherm
