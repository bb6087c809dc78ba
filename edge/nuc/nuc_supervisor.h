#pragma once

#include <optional>

#include "common/frame/frame.h"

namespace isotherm {

class NucOptions;

/// What is known about the thermal camera's correction at one frame.
struct NucStatus {
  NucState state = NucState::kUnknown;
  NucSource source = NucSource::kUnknown;
  std::optional<double> seconds_since_nuc;  ///< Since the shutter opened; nullopt = none seen yet.
  bool valid = false;                       ///< Temperatures may reach the model.
};

/// Follows the non-uniformity correction (NUC) from the shutter flag that the camera puts into its
/// frames and decides whether a frame's temperatures are valid.
///
///   kUnknown    --(no initial NUC required)---> kIdle         (at the first frame)
///   any         --(shutter closed)------------> kInProgress
///   kInProgress --(shutter open)--------------> kSettling
///   kSettling   --(settle time elapsed)-------> kIdle
///
/// Only kIdle is valid. Owns no device, thread or clock: time enters through Update.
/// Thread-compatible.
class NucSupervisor {
 public:
  explicit NucSupervisor(const NucOptions& options);

  /// Advances to the frame captured at `time`, which must not decrease between calls.
  NucStatus Update(CaptureTime time, bool shutter_closed);

 private:
  NucState NextState(CaptureTime time, bool shutter_closed) const;

  const Nanoseconds settle_time_;
  const bool require_initial_nuc_;
  NucState state_ = NucState::kUnknown;
  std::optional<CaptureTime> shutter_opened_at_;
};

}  // namespace isotherm
