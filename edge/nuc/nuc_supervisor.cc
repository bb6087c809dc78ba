#include "edge/nuc/nuc_supervisor.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "edge/options/edge_options.pb.h"

namespace isotherm {
namespace {

// A camera that was silent for so long may have been unplugged, and is back as it was built.
constexpr Nanoseconds kSilence = std::chrono::seconds(2);

NucPolicy PolicyOf(const NucOptions& options) {
  switch (options.policy()) {
    case NucOptions::MANUAL:
      return NucPolicy::kManual;
    case NucOptions::CAMERA:
      return NucPolicy::kCamera;
    case NucOptions::AUTOMATIC:
      break;
  }
  return NucPolicy::kAutomatic;
}

/// The driver compares images too, and knows how often the camera repeats them.
bool FoundFrozenByDriver(const NucObservation& seen) {
  return seen.shutter_closed && seen.camera && seen.camera->source == NucSource::kInferred;
}

/// Empty if `now` is within `limit_k` of `then`, if either is not known, or without a limit.
std::string Drift(const char* part, float then_celsius, float now_celsius, double limit_k) {
  const double drift_k = static_cast<double>(now_celsius) - static_cast<double>(then_celsius);
  if (limit_k <= 0.0 || !(std::abs(drift_k) > limit_k)) return "";
  return fmt::format("the {} is {:+.2f} K off the last correction", part, drift_k);
}

}  // namespace

NucSupervisor::NucSupervisor(const NucOptions& options, Role role)
    : options_(std::make_unique<const NucOptions>(options)),
      role_(role),
      policy_(PolicyOf(options)),
      warm_up_(options) {}

NucSupervisor::~NucSupervisor() = default;

void NucSupervisor::Note(LogLevel level, std::string text) {
  notices_.push_back({frame_time_, level, std::move(text)});
}

std::vector<NucNotice> NucSupervisor::TakeNotices() { return std::exchange(notices_, {}); }

NucStatus NucSupervisor::Update(const NucObservation& seen) {
  Advance(seen);
  shutter_.Update(now_, ClosedBy(seen));
  OnShutter(seen);
  FollowOrder();
  FollowHold();
  FollowStorm();
  FollowWarmUp(seen.housekeeping);
  due_ = DueReason(seen);
  state_ = NextState(seen);
  NucStatus status;
  status.order = NextOrder(seen);
  reason_ = Explain(seen);
  status.state = state_;
  status.valid = IsValid(seen);
  status.source = seen.camera && !shutter_.is_closed() ? seen.camera->source : shutter_.source();
  if (shutter_.opened_at()) {
    status.seconds_since_nuc = ToSeconds(now_ - *shutter_.opened_at());
  } else if (seen.camera) {
    status.seconds_since_nuc = seen.camera->seconds_since;
  }
  return status;
}

void NucSupervisor::Advance(const NucObservation& seen) {
  reports_shutter_ = reports_shutter_ || seen.shutter_closed || seen.camera;
  if (!first_frame_) {
    first_frame_ = now_ = frame_time_ = seen.time;
    reference_ = seen.housekeeping;
    return;
  }
  const Nanoseconds passed = std::max(Nanoseconds(0), Nanoseconds(seen.time - frame_time_));
  frame_time_ = seen.time;
  now_ += passed;
  if (passed > kSilence && role_ == Role::kSupervise) {
    automatic_.reset();
    trigger_unanswered_ = false;
    cannot_trigger_ = false;
    attempts_ = 0;
    if (options_->before_scan()) nuc_seen_ = first_nuc_waived_ = false;
    Note(LogLevel::kInfo,
         fmt::format("no thermal frame for {:.1f} s: the camera's mode is set again",
                     ToSeconds(passed)));
  }
}

std::optional<NucSource> NucSupervisor::ClosedBy(const NucObservation& seen) const {
  if (FoundFrozenByDriver(seen)) return NucSource::kInferred;
  if (seen.camera && seen.camera->state == NucState::kInProgress) return seen.camera->source;
  if (seen.shutter_closed) return NucSource::kInBand;
  if (seen.image.is_frozen) return NucSource::kInferred;
  if (seen.image.is_like_shutter && !reports_shutter_) return NucSource::kInferred;
  if (commanded_until_ && now_ < *commanded_until_) return NucSource::kCommanded;
  return std::nullopt;
}

void NucSupervisor::OnShutter(const NucObservation& seen) {
  if (shutter_.just_closed()) {
    const bool ordered =
        trigger_unanswered_ || waiting_since_.has_value() || commanded_until_.has_value();
    trigger_unanswered_ = false;
    waiting_since_.reset();
    if (!storm_) {
      Note(LogLevel::kInfo, fmt::format("shutter closed{}, known by {}",
                                        ordered ? " as ordered" : ", not ordered by us",
                                        ToString(shutter_.source())));
    }
  }
  if (IsStuck(seen) && !std::exchange(reported_stuck_, true)) {
    Note(LogLevel::kError,
         fmt::format("{} for {:.1f} s: no temperatures are taken, geometry goes on",
                     IsFrozen(seen)
                         ? "thermal frames are frozen (or nuc.native_repeats is too small)"
                         : "the correction does not end: the shutter is closed",
                     ToSeconds(shutter_.closed_for())));
  }
  if (!shutter_.just_opened()) return;
  reported_stuck_ = false;
  nuc_seen_ = true;
  requested_ = false;
  attempts_ = 0;
  hold_used_up_ = false;
  commanded_until_.reset();
  reference_ = seen.housekeeping;
  if (!storm_) {
    Note(LogLevel::kInfo, fmt::format("shutter open after {:.2f} s, settling for {:.2f} s",
                                      ToSeconds(shutter_.closed_for()), options_->settle_time_s()));
  }
}

bool NucSupervisor::IsFrozen(const NucObservation& seen) const {
  const bool frozen = seen.image.is_frozen || FoundFrozenByDriver(seen);
  return frozen && shutter_.source() == NucSource::kInferred;
}

bool NucSupervisor::IsStuck(const NucObservation& seen) const {
  if (!shutter_.is_closed()) return false;
  double limit_s = options_->max_duration_s();
  if (IsFrozen(seen) && options_->frozen_restart_s() > 0.0)
    limit_s = std::min(limit_s, options_->frozen_restart_s());
  return shutter_.closed_for() > FromSeconds(limit_s);
}

void NucSupervisor::FollowOrder() {
  if (!waiting_since_ || now_ - *waiting_since_ < FromSeconds(options_->answer_s())) return;
  waiting_since_.reset();
  Note(LogLevel::kWarning,
       fmt::format("ordered, but the shutter did not close within {:.1f} s (attempt {} of {})",
                   options_->answer_s(), attempts_, options_->max_attempts()));
  if (attempts_ >= options_->max_attempts()) GiveUp();
}

void NucSupervisor::FollowHold() {
  if (!held_until_ || now_ < *held_until_) return;
  held_until_.reset();
  hold_started_.reset();
  hold_used_up_ = !due_.empty();
  Note(LogLevel::kInfo, due_.empty() ? "hold is over" : "hold is over; due: " + due_);
}

void NucSupervisor::FollowStorm() {
  const bool storm = shutter_.closings_per_minute() > options_->max_closings_per_minute();
  if (storm == storm_) return;
  storm_ = storm;
  Note(storm ? LogLevel::kWarning : LogLevel::kInfo,
       fmt::format("{}: {} corrections in the last minute, shutter closed for {:.0f} % of it{}",
                   storm ? "storm of corrections" : "storm is over", shutter_.closings_per_minute(),
                   100.0 * shutter_.closed_fraction(),
                   storm ? "; geometry goes on, no correction is ordered" : ""));
}

void NucSupervisor::FollowWarmUp(const ThermalHousekeeping& housekeeping) {
  if (role_ == Role::kFollow || options_->warm_up() == NucOptions::IGNORE) return;
  const WarmUpWatch::State before =
      std::exchange(warm_up_state_, warm_up_.Update(now_, housekeeping));
  if (before == warm_up_state_) return;
  if (warm_up_state_ == WarmUpWatch::State::kWarm) {
    if (before == WarmUpWatch::State::kCold) Note(LogLevel::kInfo, "the thermal camera is warm");
    return;
  }
  if (warm_up_state_ != WarmUpWatch::State::kCold) return;
  const std::string what =
      warm_up_.rate_k_per_min()
          ? fmt::format("warms up by {:+.1f} K/min (warm below {:.1f})", *warm_up_.rate_k_per_min(),
                        options_->warm_up_rate_k_per_min())
          : fmt::format("tells no temperature: counted as warm in {:.0f} s",
                        ToSeconds(warm_up_.left()));
  Note(LogLevel::kWarning, fmt::format("the thermal camera {}; {}", what,
                                       WaitsForWarmUp() ? "no temperatures are taken until then"
                                                        : "temperatures may be off"));
}

bool NucSupervisor::WaitsForWarmUp() const {
  return role_ == Role::kSupervise && options_->warm_up() == NucOptions::WAIT &&
         warm_up_state_ != WarmUpWatch::State::kWarm;
}

bool NucSupervisor::NeedsFirstNuc() const {
  if (nuc_seen_) return false;
  if (options_->require_initial_nuc()) return true;
  return role_ == Role::kSupervise && options_->before_scan() && !first_nuc_waived_;
}

std::string NucSupervisor::DriftReason(const ThermalHousekeeping& now) const {
  const std::string housing = Drift("housing", reference_.housing_celsius, now.housing_celsius,
                                    options_->max_housing_drift_k());
  if (!housing.empty()) return housing;
  return Drift("detector", reference_.fpa_celsius, now.fpa_celsius, options_->max_fpa_drift_k());
}

std::string NucSupervisor::DueReason(const NucObservation& seen) const {
  if (shutter_.is_closed() || role_ == Role::kFollow || WaitsForWarmUp()) return "";
  if (requested_) return "asked for";
  if (policy_ != NucPolicy::kAutomatic || cannot_trigger_) return "";
  if (NeedsFirstNuc() || (options_->before_scan() && !nuc_seen_)) return "start of the scan";
  if (seen.camera && seen.camera->state == NucState::kDesired) return "the camera asks for it";
  std::string drift = DriftReason(seen.housekeeping);
  if (!drift.empty()) return drift;
  const double age_s = ToSeconds(now_ - shutter_.opened_at().value_or(*first_frame_));
  if (options_->max_interval_s() > 0.0 && age_s > options_->max_interval_s())
    return fmt::format("the last correction is {:.0f} s old", age_s);
  return "";
}

CaptureTime NucSupervisor::EarliestTrigger() const {
  const Nanoseconds pause = FromSeconds(options_->min_interval_s());
  CaptureTime earliest = now_;
  if (last_trigger_) earliest = std::max(earliest, *last_trigger_ + pause);
  if (shutter_.opened_at()) earliest = std::max(earliest, *shutter_.opened_at() + pause);
  return earliest;
}

bool NucSupervisor::MayTrigger() const {
  return !due_.empty() && !trigger_unanswered_ && !waiting_since_ && !shutter_.is_closed() &&
         !IsHeld() && !storm_ && attempts_ < options_->max_attempts() && now_ >= EarliestTrigger();
}

std::optional<NucOrder> NucSupervisor::NextOrder(const NucObservation& seen) {
  if (role_ == Role::kFollow) return std::nullopt;
  const Nanoseconds pause = FromSeconds(options_->min_interval_s());
  const bool may_restart = !last_restart_ || now_ - *last_restart_ >= pause;
  if (IsStuck(seen) && IsFrozen(seen) && options_->frozen_restart_s() > 0.0 && may_restart) {
    last_restart_ = now_;
    return NucOrder::kRestartCamera;
  }
  const bool automatic = policy_ == NucPolicy::kCamera && !IsHeld();
  if (automatic_ != automatic) {
    automatic_ = automatic;
    return automatic ? NucOrder::kAutomaticOn : NucOrder::kAutomaticOff;
  }
  if (!MayTrigger()) return std::nullopt;
  last_trigger_ = now_;
  trigger_unanswered_ = true;
  ++attempts_;
  ordered_for_ = due_;
  return NucOrder::kTrigger;
}

NucState NucSupervisor::NextState(const NucObservation& seen) const {
  const NucState camera = seen.camera ? seen.camera->state : NucState::kUnknown;
  if (camera == NucState::kError || IsStuck(seen)) return NucState::kError;
  if (shutter_.is_closed()) return NucState::kInProgress;
  if (shutter_.opened_at() && now_ - *shutter_.opened_at() < FromSeconds(options_->settle_time_s()))
    return NucState::kSettling;
  if (camera == NucState::kSettling) return NucState::kSettling;
  if (trigger_unanswered_ || waiting_since_ || camera == NucState::kImminent)
    return NucState::kImminent;
  const bool given_up = !due_.empty() && attempts_ >= options_->max_attempts();
  if (given_up || camera == NucState::kBlocked) return NucState::kBlocked;
  if (NeedsFirstNuc() || WaitsForWarmUp()) return NucState::kUnknown;
  if (!due_.empty() || camera == NucState::kDesired) return NucState::kDesired;
  return NucState::kIdle;
}

bool NucSupervisor::IsValid(const NucObservation& seen) const {
  if (NeedsFirstNuc() || WaitsForWarmUp()) return false;
  switch (state_) {
    case NucState::kIdle:
    case NucState::kDesired:
    case NucState::kBlocked:
      return true;
    case NucState::kImminent:
      // Who is told late, or not at all, could take the shutter for the scene.
      return seen.camera ? seen.camera->source == NucSource::kInBand : reports_shutter_;
    default:
      return false;
  }
}

std::string NucSupervisor::Explain(const NucObservation& seen) const {
  switch (state_) {
    case NucState::kUnknown:
      return WaitsForWarmUp() ? "waiting until the camera is warm" : "no correction yet";
    case NucState::kDesired: {
      if (IsHeld())
        return fmt::format("held for {:.0f} s: {}", ToSeconds(*held_until_ - now_), due_);
      return due_.empty() ? "the camera asks for it" : due_;
    }
    case NucState::kImminent:
      return trigger_unanswered_ || waiting_since_ ? "ordered: " + ordered_for_
                                                   : "announced by the camera";
    case NucState::kBlocked:
      return due_.empty() ? "the camera says that it cannot"
                          : "the camera does not follow: " + due_;
    case NucState::kError:
      if (!IsStuck(seen)) return "the camera reports an error";
      return fmt::format("{} for {:.0f} s", IsFrozen(seen) ? "frozen" : "shutter closed",
                         ToSeconds(shutter_.closed_for()));
    default:
      return "";
  }
}

}  // namespace isotherm
