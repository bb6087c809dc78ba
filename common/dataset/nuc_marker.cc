#include "common/dataset/import.h"

namespace isotherm {

void NucMarker::Mark(ThermalFrame& frame) {
  const CaptureTime now = frame.header.capture_time;
  for (; next_ < intervals_.size() && intervals_[next_].end < now; ++next_)
    last_end_ = intervals_[next_].end;
  const bool inside = next_ < intervals_.size() && intervals_[next_].start <= now;
  const bool repeated = !inside && frozen_ && *frozen_ == frame.temperature_raw;
  if (inside || repeated) {
    frame.nuc_state = NucState::kInProgress;
    frame.nuc_source = inside ? NucSource::kInBand : NucSource::kInferred;
    frame.seconds_since_nuc.reset();
    frame.valid = false;
    frozen_ = frame.temperature_raw;
    return;
  }
  frozen_.reset();
  frame.nuc_state = NucState::kIdle;
  frame.nuc_source = NucSource::kInBand;
  if (last_end_) frame.seconds_since_nuc = ToSeconds(now - *last_end_);
  frame.valid = true;
}

}  // namespace isotherm
