#include "edge/nuc/shutter_log.h"

#include <algorithm>

namespace isotherm {
namespace {

// Closings are counted over a minute, as nuc.expert.max_closings_per_minute says.
constexpr Nanoseconds kWindow = std::chrono::minutes(1);

}  // namespace

void ShutterLog::Update(CaptureTime time, std::optional<NucSource> closed_by) {
  now_ = time;
  if (!first_frame_) first_frame_ = time;
  just_closed_ = closed_by && !closed_at_;
  just_opened_ = !closed_by && closed_at_;
  if (just_closed_) {
    closed_at_ = time;
    ++closings_;
    last_minute_.push_back({time, time});
  }
  if (closed_by) source_ = *closed_by;
  if (closed_at_) {
    closed_for_ = time - *closed_at_;
    last_minute_.back().end = time;
  }
  if (just_opened_) {
    closed_at_.reset();
    opened_at_ = time;
  }
  // A closing that is still going on stays, whenever it began.
  while (!last_minute_.empty() && last_minute_.front().end < now_ - kWindow) {
    last_minute_.pop_front();
  }
}

double ShutterLog::closed_fraction() const {
  if (!first_frame_) return 0.0;
  const CaptureTime start = std::max(*first_frame_, now_ - kWindow);
  if (now_ <= start) return closed_at_ ? 1.0 : 0.0;
  Nanoseconds closed{0};
  for (const Closing& closing : last_minute_)
    closed += closing.end - std::max(closing.start, start);
  return ToSeconds(closed) / ToSeconds(now_ - start);
}

}  // namespace isotherm
