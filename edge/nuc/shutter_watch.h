#pragma once

#include <optional>
#include <string>

#include "edge/nuc/nuc_notices.h"
#include "edge/nuc/nuc_observation.h"
#include "edge/nuc/shutter_log.h"

namespace isotherm {

class NucOptions;

/// Follows the shutter of the thermal camera: by what the camera says, by the images, or by the
/// order for cameras that tell nothing.
///
///   open     --(closed, from whatever source)------------> closed
///   closed   --(longer than a correction takes)----------> stuck (failures F05, F08)
///   closed, stuck --(open)-------------------------------> settling
///   settling --(settle time elapsed)---------------------> open
///
/// Beside it: too many closings in a minute are a storm (failure F08).
/// Times are those of frames and must not decrease. Thread-compatible.
class ShutterWatch {
 public:
  /// `notices` must outlive it.
  ShutterWatch(const NucOptions& options, NucNotices& notices);

  /// Advances to a frame. `ordered`: a correction was ordered and has not begun yet.
  void Update(CaptureTime now, const NucObservation& seen, bool ordered);
  /// Looks at the closings of the last minute.
  void FollowStorm();
  /// The camera takes an order at `now`. If it tells nothing of its shutter, that counts as closed
  /// for the time that a correction takes, from the next frame on.
  void CloseBlindly(CaptureTime now);
  /// Returns whether the camera is to be opened again because it is frozen; it is then taken as
  /// done.
  bool TakeRestart(CaptureTime now);

  bool just_closed() const { return log_.just_closed(); }
  bool just_opened() const { return log_.just_opened(); }
  bool is_closed() const { return log_.is_closed(); }
  /// Closed, or frozen, for longer than a correction takes.
  bool is_stuck() const { return is_stuck_; }
  /// By the images alone: the camera does not say that its shutter is closed.
  bool is_frozen() const { return is_frozen_; }
  bool is_settling(CaptureTime now) const;
  bool is_storm() const { return is_storm_; }
  /// Says why nothing is ordered in a storm.
  std::string StormText() const;
  /// The camera says when its shutter is closed.
  bool is_reported() const { return is_reported_; }
  const ShutterLog& log() const { return log_; }

 private:
  std::optional<NucSource> ClosedBy(CaptureTime now, const NucObservation& seen) const;
  bool LastsTooLong() const;
  void NoteStuck();

  /// Holds the options and bounds by which closings are found normal.
  struct Limits {
    Nanoseconds settle_time, longest, longest_frozen, commanded, restart_pause;
    bool restarts_frozen;
    int max_closings_per_minute;
  };
  const Limits limits_;
  NucNotices& notices_;
  ShutterLog log_;
  std::optional<CaptureTime> commanded_until_;  ///< For cameras that do not tell.
  std::optional<CaptureTime> last_restart_;
  bool is_reported_ = false;
  bool is_frozen_ = false;
  bool is_stuck_ = false;
  bool is_stuck_noted_ = false;
  bool is_storm_ = false;
};

}  // namespace isotherm
