#include "common/dataset/import.h"

namespace isotherm {

void NucMarker::Mark(ThermalFrame& frame) {
  const CaptureTime now = frame.header.capture_time;
  for (; next_ < intervals_.size() && intervals_[next_].end < now; ++next_)
    last_end_ = intervals_[next_].end;
  const bool inside = next_ < intervals_.size() && intervals_[next_].start <= now;
  const bool is_repeat = repeats_.Add(frame.temperature_raw) > 0;
  was_marked_ = inside || (was_marked_ && is_repeat);
  if (was_marked_) {
    frame.nuc_state = NucState::kInProgress;
    frame.nuc_source = inside ? NucSource::kInBand : NucSource::kInferred;
    frame.seconds_since_nuc.reset();
    frame.valid = false;
    return;
  }
  frame.nuc_state = NucState::kIdle;
  frame.nuc_source = NucSource::kInBand;
  if (last_end_) frame.seconds_since_nuc = ToSeconds(now - *last_end_);
  frame.valid = true;
}

}  // namespace isotherm
