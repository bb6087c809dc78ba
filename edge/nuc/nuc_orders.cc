// What others want of the supervisor, and how the camera answers.
#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "edge/nuc/nuc_supervisor.h"
#include "edge/options/edge_options.pb.h"

namespace isotherm {
namespace {

constexpr std::string_view kNoCamera = "a recording is played: there is no shutter to command";

}  // namespace

Result<std::string> NucSupervisor::Request() {
  if (role_ == Role::kFollow) return Err(Unavailable(std::string(kNoCamera)));
  if (!first_frame_) return Err(Unavailable("no thermal frame has come yet"));
  if (shutter_.is_closed()) return "a correction is running";
  if (IsHeld()) {
    return Err(FailedPrecondition(
        fmt::format("corrections are held for another {:.0f} s", ToSeconds(*held_until_ - now_))));
  }
  if (storm_) {
    return Err(FailedPrecondition(
        fmt::format("{} corrections in the last minute, more than {}: none is ordered",
                    shutter_.closings_per_minute(), options_->max_closings_per_minute())));
  }
  if (waiting_since_) return "a correction was ordered already";
  if (trigger_unanswered_) return "";
  requested_ = true;
  cannot_trigger_ = false;
  attempts_ = 0;
  const double wait_s = ToSeconds(EarliestTrigger() - now_);
  if (WaitsForWarmUp()) return "as soon as the camera is warm";
  if (wait_s <= 0.0) return "";
  return fmt::format("in {:.0f} s: corrections are at least {:.0f} s apart", wait_s,
                     options_->min_interval_s());
}

Result<std::string> NucSupervisor::Hold(double seconds) {
  if (role_ == Role::kFollow) return Err(Unavailable(std::string(kNoCamera)));
  if (!first_frame_) return Err(Unavailable("no thermal frame has come yet"));
  if (!(seconds >= 0.0)) return Err(InvalidArgument("a hold lasts 0 s or longer"));
  if (seconds == 0.0) {
    held_until_.reset();
    hold_started_.reset();
    Note(LogLevel::kInfo, "hold ended by the operator");
    return "corrections are not held";
  }
  if (hold_used_up_) {
    return Err(FailedPrecondition(
        fmt::format("corrections were held for the {:.0f} s that are allowed; one must come first",
                    options_->max_hold_s())));
  }
  if (!hold_started_) hold_started_ = now_;
  const CaptureTime last = *hold_started_ + FromSeconds(options_->max_hold_s());
  // What is longer than any scan must not overflow the clock.
  const double longest_s = ToSeconds(last - now_);
  held_until_ = now_ + FromSeconds(std::min(seconds, longest_s));
  std::string text =
      fmt::format("corrections are held for {:.0f} s", ToSeconds(*held_until_ - now_));
  if (seconds > longest_s) text += ", the most that nuc.max_hold_s allows";
  Note(LogLevel::kInfo, text);
  return text;
}

Status NucSupervisor::SetPolicy(NucPolicy policy) {
  if (role_ == Role::kFollow) return Unavailable(std::string(kNoCamera));
  policy_ = policy;
  attempts_ = 0;
  Note(LogLevel::kInfo, fmt::format("policy: {}", ToString(policy)));
  return OkStatus();
}

void NucSupervisor::OnAnswer(NucOrder order, const Status& answer) {
  switch (order) {
    case NucOrder::kRestartCamera:
      Note(LogLevel::kWarning, answer.ok()
                                   ? "the thermal camera is restarted"
                                   : "the thermal camera cannot be restarted: " + answer.message());
      return;
    case NucOrder::kAutomaticOn:
    case NucOrder::kAutomaticOff:
      if (answer.ok()) return;
      Note(LogLevel::kInfo,
           fmt::format("the camera's own corrections cannot be switched {}: {}",
                       order == NucOrder::kAutomaticOn ? "on" : "off", answer.message()));
      return;
    case NucOrder::kTrigger:
      break;
  }
  // The shutter may have closed before the answer came.
  const bool still_open = std::exchange(trigger_unanswered_, false);
  if (answer.ok()) {
    Note(LogLevel::kInfo, "correction ordered: " + ordered_for_);
    if (!still_open) return;
    if (reports_shutter_) {
      waiting_since_ = now_;
    } else {
      commanded_until_ = now_ + FromSeconds(options_->commanded_duration_s());
    }
    return;
  }
  requested_ = false;
  cannot_trigger_ = answer.code() == StatusCode::kFailedPrecondition;
  Note(LogLevel::kWarning, fmt::format("correction refused ({}): {}",
                                       cannot_trigger_ ? "the camera's own are followed"
                                                       : fmt::format("attempt {} of {}", attempts_,
                                                                     options_->max_attempts()),
                                       answer.message()));
  // Nothing has happened that the next request would have to keep its distance from.
  if (cannot_trigger_) last_trigger_.reset();
  if (cannot_trigger_ || attempts_ >= options_->max_attempts()) GiveUp();
}

void NucSupervisor::GiveUp() {
  requested_ = false;
  if (!NeedsFirstNuc()) return;
  first_nuc_waived_ = true;
  Note(LogLevel::kWarning, options_->require_initial_nuc()
                               ? "no first correction: no temperatures are taken"
                               : "no first correction: the scan goes on without");
}

}  // namespace isotherm
