#include "edge/nuc/nuc_supervisor.h"

#include <fmt/format.h>

#include <utility>

#include "common/base/units.h"
#include "common/options/option_problems.h"
#include "edge/options/edge_options.pb.h"

namespace isotherm {
namespace {

// A camera that was silent for this long may have been unplugged, and is back as it was built.
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

}  // namespace

Status Validate(const NucOptions& options) {
  OptionProblems problems("nuc");
  problems.CheckRange("expert.settle_time_s", options.expert().settle_time_s(), 0.0, 60.0);
  problems.CheckRange("expert.max_housing_drift_k", options.expert().max_housing_drift_k(), 0.0,
                      100.0);
  problems.CheckRange("expert.max_fpa_drift_k", options.expert().max_fpa_drift_k(), 0.0, 100.0);
  problems.CheckRange("max_interval_s", options.max_interval_s(), 0.0, 24.0 * kSPerHour);
  problems.CheckRange("expert.min_interval_s", options.expert().min_interval_s(), 0.5, kSPerHour);
  problems.CheckRange("expert.max_hold_s", options.expert().max_hold_s(), 0.0, kSPerHour);
  problems.CheckRange("expert.answer_s", options.expert().answer_s(), 0.1, 60.0);
  problems.CheckRange("expert.max_attempts", options.expert().max_attempts(), 1, 100);
  problems.CheckRange("expert.max_duration_s", options.expert().max_duration_s(), 0.1, 600.0);
  problems.CheckRange("expert.commanded_duration_s", options.expert().commanded_duration_s(), 0.0,
                      60.0);
  problems.CheckRange("expert.native_repeats", options.expert().native_repeats(), 1, 100);
  problems.CheckRange("expert.shutter_like_spread", options.expert().shutter_like_spread(), 0.0,
                      1.0);
  problems.CheckRange("expert.max_closings_per_minute", options.expert().max_closings_per_minute(),
                      1, 600);
  problems.CheckRange("expert.warm_up_rate_k_per_min", options.expert().warm_up_rate_k_per_min(),
                      0.001, 100.0);
  problems.CheckRange("expert.warm_up_stable_s", options.expert().warm_up_stable_s(), 1.0,
                      kSPerHour);
  problems.CheckRange("expert.warm_up_housing_rate_k_per_min",
                      options.expert().warm_up_housing_rate_k_per_min(), 0.001, 100.0);
  problems.CheckRange("expert.warm_up_housing_stable_s",
                      options.expert().warm_up_housing_stable_s(), 1.0, kSPerHour);
  problems.CheckRange("expert.warm_up_time_s", options.expert().warm_up_time_s(), 0.0,
                      24.0 * kSPerHour);
  problems.CheckRange("expert.frozen_restart_s", options.expert().frozen_restart_s(), 0.0, 600.0);
  return problems.ToStatus();
}

NucSupervisor::NucSupervisor(const NucOptions& options, Role role)
    : role_(role),
      policy_(PolicyOf(options)),
      shutter_(options, notices_),
      orders_(options, notices_),
      need_(options, role == Role::kSupervise, notices_),
      hold_(options, notices_),
      warm_up_(options, role == Role::kSupervise, notices_) {}

NucStatus NucSupervisor::Update(const NucObservation& seen) {
  // The order matters: the shutter is known before orders are assessed by it, needs before a state
  // is named by them, and the state before an order changes it.
  Advance(seen);
  FollowShutter(seen);
  if (orders_.IsLastOneMissed(clock_.now())) GiveUp();
  hold_.Update(clock_.now(), due_);
  shutter_.FollowStorm();
  warm_up_.Update(clock_.now(), seen.housekeeping);
  due_ = DueReason(seen);
  const NucFacts facts = Facts(seen);
  NucStatus status;
  status.state = StateFrom(facts);
  status.valid = IsValid(status.state, facts);
  status.order = NextOrder();
  status.source = seen.camera && !shutter_.is_closed() ? seen.camera->source : shutter().source();
  status.seconds_since_nuc = SecondsSinceNuc(seen);
  reason_ = Explain(status.state);
  return status;
}

void NucSupervisor::Advance(const NucObservation& seen) {
  if (!clock_.has_begun()) need_.SetReference(seen.housekeeping);
  const Nanoseconds passed = clock_.Advance(seen.time);
  notices_.SetTime(seen.time);
  // Recordings may have pauses; their camera is not there to be set.
  if (passed <= kSilence || role_ == Role::kFollow) return;
  orders_.OnCameraAway();
  need_.OnCameraAway();
  notices_.Add(LogLevel::kInfo,
               fmt::format("no thermal frame for {:.1f} s: the camera's mode is set again",
                           ToSeconds(passed)));
}

void NucSupervisor::FollowShutter(const NucObservation& seen) {
  shutter_.Update(clock_.now(), seen, orders_.is_pending());
  if (shutter_.just_closed()) orders_.OnShutterClosed();
  if (!shutter_.just_opened()) return;
  // Not when it closed: a correction that never ends is none, and the request for it stays open.
  orders_.OnShutterOpened();
  need_.OnCorrected(seen.housekeeping);
  hold_.OnCorrected();
}

void NucSupervisor::GiveUp() {
  orders_.Withdraw();
  need_.OnGivenUp();
}

std::string NucSupervisor::DueReason(const NucObservation& seen) const {
  // While the shutter is closed the wish is being fulfilled. A correction before the camera is warm
  // would soon be due again.
  if (shutter_.is_closed() || role_ == Role::kFollow || warm_up_.is_waiting()) return "";
  if (orders_.is_requested()) return "asked for";
  // A person's request passes this line, whatever the policy: it stands above.
  if (policy_ != NucPolicy::kAutomatic || orders_.is_impossible()) return "";
  return need_.Reason(seen, Age());
}

/// Since the last correction, or since the first frame.
Nanoseconds NucSupervisor::Age() const {
  return clock_.now() - shutter().opened_at().value_or(clock_.first());
}

std::optional<double> NucSupervisor::SecondsSinceNuc(const NucObservation& seen) const {
  if (shutter().opened_at()) return ToSeconds(Age());
  return seen.camera ? seen.camera->seconds_since : std::nullopt;
}

NucFacts NucSupervisor::Facts(const NucObservation& seen) const {
  return {.camera = seen.camera,
          .is_stuck = shutter_.is_stuck(),
          .is_closed = shutter_.is_closed(),
          .is_settling = shutter_.is_settling(clock_.now()),
          .is_ordered = orders_.is_pending(),
          .is_given_up = !due_.empty() && !orders_.has_attempts_left(),
          .waits_for_first = need_.WaitsForFirst(),
          .waits_for_warm_up = warm_up_.is_waiting(),
          .is_due = !due_.empty(),
          .is_shutter_reported = shutter_.is_reported()};
}

std::optional<NucOrder> NucSupervisor::NextOrder() {
  if (role_ == Role::kFollow) return std::nullopt;
  // At most one order per frame, the most urgent first: frozen frames give neither temperatures nor
  // a sign whether any other order is followed.
  if (shutter_.TakeRestart(clock_.now())) return NucOrder::kRestartCamera;
  // During a hold the camera's own corrections are switched off, too, where it allows that.
  const bool automatic = policy_ == NucPolicy::kCamera && !hold_.is_held();
  if (const std::optional<NucOrder> mode = orders_.SwitchAutomatic(automatic)) return mode;
  const bool is_forbidden = shutter_.is_closed() || hold_.is_held() || shutter_.is_storm();
  if (due_.empty() || is_forbidden || !orders_.MayTrigger(clock_.now(), shutter().opened_at()))
    return std::nullopt;
  orders_.Trigger(clock_.now(), due_);
  return NucOrder::kTrigger;
}

std::string NucSupervisor::Explain(NucState state) const {
  switch (state) {
    case NucState::kUnknown:
      return warm_up_.is_waiting() ? "waiting until the camera is warm" : "no correction yet";
    case NucState::kDesired:
      if (hold_.is_held())
        return fmt::format("held for {:.0f} s: {}", ToSeconds(hold_.left(clock_.now())), due_);
      return due_.empty() ? "the camera asks for it" : due_;
    case NucState::kImminent:
      return orders_.is_pending() ? "ordered: " + orders_.ordered_for() : "announced by the camera";
    case NucState::kBlocked:
      return due_.empty() ? "the camera says that it cannot"
                          : "the camera does not follow: " + due_;
    case NucState::kError:
      if (!shutter_.is_stuck()) return "the camera reports an error";
      return fmt::format("{} for {:.0f} s", shutter_.is_frozen() ? "frozen" : "shutter closed",
                         ToSeconds(shutter().closed_for()));
    default:
      return "";
  }
}

void NucSupervisor::OnAnswer(NucOrder order, const Status& answer) {
  switch (order) {
    case NucOrder::kRestartCamera:
      notices_.Add(LogLevel::kWarning,
                   answer.ok() ? "the thermal camera is restarted"
                               : "the thermal camera cannot be restarted: " + answer.message());
      return;
    case NucOrder::kAutomaticOn:
    case NucOrder::kAutomaticOff:
      if (answer.ok()) return;
      notices_.Add(LogLevel::kInfo,
                   fmt::format("the camera's own corrections cannot be switched {}: {}",
                               order == NucOrder::kAutomaticOn ? "on" : "off", answer.message()));
      return;
    case NucOrder::kTrigger:
      OnTriggerAnswered(answer);
      return;
  }
}

void NucSupervisor::OnTriggerAnswered(const Status& answer) {
  switch (orders_.OnAnswer(answer)) {
    case NucOrders::Consequence::kNothing:
      return;
    case NucOrders::Consequence::kGiveUp:
      return GiveUp();
    case NucOrders::Consequence::kAwaitShutter:
      // A camera that tells of its shutter must be seen to close it. Of any other the order is all
      // that is known: it counts as closed for the usual time.
      if (shutter_.is_reported()) return orders_.Await(clock_.now());
      return shutter_.CloseBlindly(clock_.now());
  }
}

Status NucSupervisor::CheckCommandable() const {
  if (role_ == Role::kFollow)
    return Unavailable("a recording is played: there is no shutter to command");
  if (!clock_.has_begun()) return Unavailable("no thermal frame has come yet");
  return OkStatus();
}

Result<std::string> NucSupervisor::Request() {
  if (Status status = CheckCommandable(); !status.ok()) return Err(std::move(status));
  if (shutter_.is_closed()) return "a correction is running";
  if (hold_.is_held()) {
    return Err(FailedPrecondition(fmt::format("corrections are held for another {:.0f} s",
                                              ToSeconds(hold_.left(clock_.now())))));
  }
  if (shutter_.is_storm()) return Err(FailedPrecondition(shutter_.StormText()));
  if (orders_.state() == NucOrders::State::kAwaited) return "a correction was ordered already";
  // The order under way serves this request as well; its answer answers both.
  if (orders_.state() == NucOrders::State::kUnanswered) return "";
  orders_.Request();
  if (warm_up_.is_waiting()) return "as soon as the camera is warm";
  const double wait_s =
      ToSeconds(orders_.EarliestTrigger(clock_.now(), shutter().opened_at()) - clock_.now());
  if (wait_s <= 0.0) return "";
  return fmt::format("in {:.0f} s: corrections are at least {:.0f} s apart", wait_s,
                     ToSeconds(orders_.min_interval()));
}

Result<std::string> NucSupervisor::Hold(double seconds) {
  if (Status status = CheckCommandable(); !status.ok()) return Err(std::move(status));
  return hold_.Hold(clock_.now(), seconds);
}

Status NucSupervisor::SetPolicy(NucPolicy policy) {
  if (role_ == Role::kFollow) return CheckCommandable();
  policy_ = policy;
  // A new policy gets new attempts: the old one may have used them up.
  orders_.Renew();
  notices_.Add(LogLevel::kInfo, fmt::format("policy: {}", ToString(policy)));
  return OkStatus();
}

}  // namespace isotherm
