#include "edge/nuc/shutter_watch.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "common/messages/messages.h"
#include "edge/options/edge_options.pb.h"

namespace isotherm {
namespace {

/// The driver compares images too, and knows how often the camera repeats them.
bool FoundFrozenByDriver(const NucObservation& seen) {
  return seen.shutter_closed && seen.camera && seen.camera->source == NucSource::kInferred;
}

/// Frozen frames are acted upon before a shutter that stays closed is.
double LongestFrozen_s(const NucOptions& options) {
  if (options.expert().frozen_restart_s() <= 0.0) return options.expert().max_duration_s();
  return std::min(options.expert().max_duration_s(), options.expert().frozen_restart_s());
}

}  // namespace

ShutterWatch::ShutterWatch(const NucOptions& options, NucNotices& notices)
    : limits_{.settle_time = FromSeconds(options.expert().settle_time_s()),
              .longest = FromSeconds(options.expert().max_duration_s()),
              .longest_frozen = FromSeconds(LongestFrozen_s(options)),
              .commanded = FromSeconds(options.expert().commanded_duration_s()),
              .restart_pause = FromSeconds(options.expert().min_interval_s()),
              .restarts_frozen = options.expert().frozen_restart_s() > 0.0,
              .max_closings_per_minute = options.expert().max_closings_per_minute()},
      notices_(notices) {}

void ShutterWatch::Update(CaptureTime now, const NucObservation& seen, bool ordered) {
  // For good: a camera that has told of its shutter once tells of it always, and its images need
  // not be guessed from.
  is_reported_ = is_reported_ || seen.shutter_closed || seen.camera;
  log_.Update(now, ClosedBy(now, seen));
  is_frozen_ =
      (seen.image.is_frozen || FoundFrozenByDriver(seen)) && log_.source() == NucSource::kInferred;
  is_stuck_ = LastsTooLong();
  if (just_closed() && !is_storm_) {
    notices_.Add(LogLevel::kInfo,
                 fmt::format("shutter closed{}, known by {}",
                             ordered || commanded_until_ ? " as ordered" : ", not ordered by us",
                             ToString(log_.source())));
  }
  if (is_stuck_ && !std::exchange(is_stuck_noted_, true)) NoteStuck();
  if (!just_opened()) return;
  is_stuck_noted_ = false;
  commanded_until_.reset();
  if (!is_storm_) {
    notices_.Add(LogLevel::kInfo,
                 fmt::format("shutter open after {:.2f} s, settling for {:.2f} s",
                             ToSeconds(log_.closed_for()), ToSeconds(limits_.settle_time)));
  }
}

std::optional<NucSource> ShutterWatch::ClosedBy(CaptureTime now, const NucObservation& seen) const {
  // From the surest witness to the weakest. A driver that found its frames frozen is asked before
  // the camera's own state, which freezes with them.
  if (FoundFrozenByDriver(seen)) return NucSource::kInferred;
  if (seen.camera && seen.camera->state == NucState::kInProgress) return seen.camera->source;
  if (seen.shutter_closed) return NucSource::kInBand;
  if (seen.image.is_frozen) return NucSource::kInferred;
  if (seen.image.is_like_shutter && !is_reported_) return NucSource::kInferred;
  // Only for cameras that tell nothing: the order is taken for done.
  if (commanded_until_ && now < *commanded_until_) return NucSource::kCommanded;
  return std::nullopt;
}

bool ShutterWatch::LastsTooLong() const {
  if (!log_.is_closed()) return false;
  return log_.closed_for() > (is_frozen_ ? limits_.longest_frozen : limits_.longest);
}

void ShutterWatch::NoteStuck() {
  notices_.Add(
      LogLevel::kError,
      fmt::format("{} for {:.1f} s: no temperatures are taken, geometry goes on",
                  is_frozen_
                      ? "thermal frames are frozen (or nuc.expert.native_repeats is too small)"
                      : "the correction does not end: the shutter is closed",
                  ToSeconds(log_.closed_for())));
}

void ShutterWatch::FollowStorm() {
  const bool storm = log_.closings_per_minute() > limits_.max_closings_per_minute;
  if (std::exchange(is_storm_, storm) == storm) return;
  notices_.Add(
      storm ? LogLevel::kWarning : LogLevel::kInfo,
      fmt::format("{}: {} corrections in the last minute, shutter closed for {:.0f} % of it{}",
                  storm ? "storm of corrections" : "storm is over", log_.closings_per_minute(),
                  100.0 * log_.closed_fraction(),
                  storm ? "; geometry goes on, no correction is ordered" : ""));
}

std::string ShutterWatch::StormText() const {
  return fmt::format("{} corrections in the last minute, more than {}: none is ordered",
                     log_.closings_per_minute(), limits_.max_closings_per_minute);
}

void ShutterWatch::CloseBlindly(CaptureTime now) { commanded_until_ = now + limits_.commanded; }

bool ShutterWatch::TakeRestart(CaptureTime now) {
  if (!is_stuck_ || !is_frozen_ || !limits_.restarts_frozen) return false;
  // A camera needs time to come back; restarting it again meanwhile would keep it away.
  if (last_restart_ && now - *last_restart_ < limits_.restart_pause) return false;
  last_restart_ = now;
  return true;
}

bool ShutterWatch::is_settling(CaptureTime now) const {
  return log_.opened_at() && now - *log_.opened_at() < limits_.settle_time;
}

}  // namespace isotherm
