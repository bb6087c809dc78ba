#include "ground/thermal/nuc_epochs.h"

namespace isotherm {

NucAge NucEpochs::Follow(const ThermalFrame& frame) {
  const std::optional<double> seconds = frame.seconds_since_nuc;
  const bool fell = seconds && last_seconds_ && *seconds < *last_seconds_;
  if (seconds) last_seconds_ = seconds;
  if (!frame.valid) {
    // One NUC, however many frames it takes.
    if (!shut_ && had_valid_) ++age_.epoch;
    shut_ = true;
    last_shut_ = frame.header.capture_time;
  } else {
    if (fell && !shut_) ++age_.epoch;
    shut_ = false;
    had_valid_ = true;
  }
  age_.seconds_since = seconds;
  if (!seconds && last_shut_)
    age_.seconds_since = ToSeconds(frame.header.capture_time - *last_shut_);
  return age_;
}

}  // namespace isotherm
