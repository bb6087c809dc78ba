#include "ground/thermal/nuc_epochs.h"

#include <cmath>

namespace isotherm {

void NucEpochs::CountNuc() {
  ++age_.epoch;
  had_nuc_ = true;
}

NucAge NucEpochs::Follow(const ThermalFrame& frame) {
  const std::optional<double> seconds = frame.seconds_since_nuc;
  const bool fell = seconds && last_seconds_ && *seconds < *last_seconds_;
  if (seconds) last_seconds_ = seconds;
  if (!frame.valid) {
    // One NUC, however many frames it takes.
    if (!shut_ && had_valid_) CountNuc();
    housing_celsius_.reset();
    shut_ = true;
    last_shut_ = frame.header.capture_time;
  } else {
    if (fell && !shut_) {
      CountNuc();
      housing_celsius_.reset();
    }
    shut_ = false;
    had_valid_ = true;
  }
  if (!first_) first_ = frame.header.capture_time;
  age_.seconds_followed = ToSeconds(frame.header.capture_time - *first_);
  age_.seconds_since = seconds;
  if (!seconds && last_shut_)
    age_.seconds_since = ToSeconds(frame.header.capture_time - *last_shut_);
  age_.housing_change_k.reset();
  if (const float now = frame.housekeeping.housing_celsius; frame.valid && std::isfinite(now)) {
    if (!housing_celsius_) {
      housing_celsius_ = now;
      age_.unseen_s = had_nuc_ ? age_.seconds_since.value_or(0.0) : 0.0;
    }
    age_.housing_change_k = static_cast<double>(now) - static_cast<double>(*housing_celsius_);
  }
  return age_;
}

}  // namespace isotherm
