#pragma once

#include "edge/nuc/nuc_notices.h"
#include "edge/nuc/warm_up_watch.h"

namespace isotherm {

class NucOptions;

/// Decides what a camera that is not warm yet means for the scan: nothing, a warning, or that
/// temperatures and corrections wait for it. Thread-compatible.
class WarmUpWait {
 public:
  /// `is_camera`: what plays a recording is not waited for. `notices` must outlive it.
  WarmUpWait(const NucOptions& options, bool is_camera, NucNotices& notices);

  /// `now` must not decrease between calls.
  void Update(CaptureTime now, const ThermalHousekeeping& housekeeping);

  bool is_cold() const { return state_ == WarmUpWatch::State::kCold; }
  /// No temperatures are taken, and no correction is ordered.
  bool is_waiting() const { return mode_ == Mode::kWait && state_ != WarmUpWatch::State::kWarm; }

 private:
  /// Says what a cold camera means: nothing, a warning, or that the scan waits.
  enum class Mode { kIgnore, kWarn, kWait };
  static Mode ModeOf(const NucOptions& options, bool is_camera);
  void NoteCold();

  const Mode mode_;
  NucNotices& notices_;
  WarmUpWatch watch_;
  WarmUpWatch::State state_ = WarmUpWatch::State::kNotAssessed;
};

}  // namespace isotherm
