#include "edge/nuc/nuc_orders.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "edge/options/edge_options.pb.h"

namespace isotherm {

NucOrders::NucOrders(const NucOptions& options, NucNotices& notices)
    : limits_{.min_interval = FromSeconds(options.expert().min_interval_s()),
              .answer = FromSeconds(options.expert().answer_s()),
              .max_attempts = options.expert().max_attempts()},
      notices_(notices) {}

void NucOrders::Request() {
  requested_ = true;
  // A person may ask again of a camera that has refused: it may have been changed meanwhile.
  impossible_ = false;
  attempts_ = 0;
}

CaptureTime NucOrders::EarliestTrigger(CaptureTime now,
                                       std::optional<CaptureTime> opened_at) const {
  CaptureTime earliest = now;
  if (last_trigger_) earliest = std::max(earliest, *last_trigger_ + limits_.min_interval);
  // Corrections of the camera's own count, too: what matters is how often the shutter is closed.
  if (opened_at) earliest = std::max(earliest, *opened_at + limits_.min_interval);
  return earliest;
}

bool NucOrders::MayTrigger(CaptureTime now, std::optional<CaptureTime> opened_at) const {
  return !is_pending() && has_attempts_left() && now >= EarliestTrigger(now, opened_at);
}

void NucOrders::Trigger(CaptureTime now, std::string why) {
  last_trigger_ = now;
  state_ = State::kUnanswered;
  ++attempts_;
  ordered_for_ = std::move(why);
}

std::optional<NucOrder> NucOrders::SwitchAutomatic(bool on) {
  if (automatic_ == on) return std::nullopt;
  automatic_ = on;
  return on ? NucOrder::kAutomaticOn : NucOrder::kAutomaticOff;
}

NucOrders::Consequence NucOrders::OnAnswer(const Status& answer) {
  // The shutter may have closed before the answer came.
  const bool still_open = state_ == State::kUnanswered;
  if (still_open) state_ = State::kNone;
  if (answer.ok()) {
    notices_.Add(LogLevel::kInfo, "correction ordered: " + ordered_for_);
    return still_open ? Consequence::kAwaitShutter : Consequence::kNothing;
  }
  requested_ = false;
  impossible_ = answer.code() == StatusCode::kFailedPrecondition;
  notices_.Add(
      LogLevel::kWarning,
      fmt::format("correction refused ({}): {}",
                  impossible_ ? "the camera's own are followed"
                              : fmt::format("attempt {} of {}", attempts_, limits_.max_attempts),
                  answer.message()));
  // Nothing has happened that the next request would have to keep its distance from.
  if (impossible_) last_trigger_.reset();
  return impossible_ || !has_attempts_left() ? Consequence::kGiveUp : Consequence::kNothing;
}

void NucOrders::Await(CaptureTime now) {
  state_ = State::kAwaited;
  awaited_since_ = now;
}

void NucOrders::OnShutterOpened() {
  requested_ = false;
  attempts_ = 0;
}

void NucOrders::OnCameraAway() {
  // It may be another camera, or the same as it was built: its mode is set again at the next frame.
  automatic_.reset();
  if (state_ == State::kUnanswered) state_ = State::kNone;
  impossible_ = false;
  attempts_ = 0;
}

bool NucOrders::IsLastOneMissed(CaptureTime now) {
  if (state_ != State::kAwaited || now - awaited_since_ < limits_.answer) return false;
  state_ = State::kNone;
  notices_.Add(
      LogLevel::kWarning,
      fmt::format("ordered, but the shutter did not close within {:.1f} s (attempt {} of {})",
                  ToSeconds(limits_.answer), attempts_, limits_.max_attempts));
  return !has_attempts_left();
}

}  // namespace isotherm
