#include "edge/nuc/nuc_control.h"

#include <fmt/format.h>

#include <limits>
#include <string>
#include <utility>

#include "common/base/log.h"
#include "edge/options/edge_options.pb.h"

namespace isotherm {
namespace {

/// Fills in, from the source, what the options leave open.
NucOptions Resolved(const EdgeOptions& options) {
  NucOptions nuc = options.nuc();
  if (!nuc.has_before_scan()) nuc.set_before_scan(options.source().kind() == CAMERAS);
  return nuc;
}

NucSupervisor::Role RoleFor(const EdgeOptions& options) {
  return options.source().kind() == REPLAY ? NucSupervisor::Role::kFollow
                                           : NucSupervisor::Role::kSupervise;
}

CameraControl ToControl(NucOrder order) {
  switch (order) {
    case NucOrder::kAutomaticOn:
      return SetAutomaticNuc{true};
    case NucOrder::kAutomaticOff:
      return SetAutomaticNuc{false};
    case NucOrder::kRestartCamera:
      return RestartCamera{};
    case NucOrder::kTrigger:
      break;
  }
  return TriggerNuc{};
}

NucOrder OrderOf(const CameraControl& control) {
  if (std::holds_alternative<RestartCamera>(control)) return NucOrder::kRestartCamera;
  const auto* automatic = std::get_if<SetAutomaticNuc>(&control);
  if (automatic == nullptr) return NucOrder::kTrigger;
  return automatic->on ? NucOrder::kAutomaticOn : NucOrder::kAutomaticOff;
}

/// Returns the level's name in recordings.
std::string LevelName(LogLevel level) {
  switch (level) {
    case LogLevel::kDebug:
      return "debug";
    case LogLevel::kInfo:
      return "info";
    case LogLevel::kWarning:
      return "warning";
    case LogLevel::kError:
      break;
  }
  return "error";
}

/// Says what became of an order that the camera had: one that it does not take is refused, and so
/// is what it was never told.
CommandOutcome OutcomeOfOrder(const Status& answer) {
  if (answer.ok()) return CommandOutcome::kDone;
  return answer.code() == StatusCode::kFailedPrecondition ? CommandOutcome::kRefused
                                                          : CommandOutcome::kFailed;
}

}  // namespace

NucControl::NucControl(const EdgeOptions& options, FrameSource& source)
    : source_(source),
      supervisor_(Resolved(options), RoleFor(options)),
      images_(options.nuc()),
      patience_(FromSeconds(options.nuc().expert().answer_s())) {}

NucStatus NucControl::Process(const RawFrame& frame, CaptureTime time) {
  // Answers first: one to an earlier order may end a wait that this frame would go on with.
  TakeCameraAnswers();
  GiveUpIfUnanswered(time);
  NucObservation seen;
  seen.time = time;
  seen.shutter_closed = frame.shutter_closed;
  seen.camera = frame.camera_nuc;
  seen.housekeeping = housekeeping_ = frame.housekeeping;
  const bool known_closed = frame.shutter_closed ||
                            (frame.camera_nuc && frame.camera_nuc->state == NucState::kInProgress);
  seen.image = images_.Add(frame.pixels, frame.thermal_scale, time, known_closed);
  status_ = supervisor_.Update(seen);
  if (status_.order) GiveOrder(*status_.order, time);
  LogNotices();
  return status_;
}

void NucControl::GiveOrder(NucOrder order, CaptureTime time) {
  if (order == NucOrder::kTrigger) triggered_at_ = time;
  const std::optional<Status> answer = source_.Control(ToControl(order));
  if (answer) OnCameraAnswer(order, *answer);
}

void NucControl::TakeCameraAnswers() {
  for (const ControlAnswer& answer : source_.TakeControlAnswers()) {
    const NucOrder order = OrderOf(answer.control);
    // Answers come in the order of the orders. Those that were given up on must not be taken for
    // the answer to the newest.
    const bool too_late = order == NucOrder::kTrigger && answers_too_late_ > 0;
    if (too_late) {
      --answers_too_late_;
      LOG(Nuc, Warning) << "the camera answers an order too late: "
                        << (answer.status.ok() ? "done" : answer.status.message());
      continue;
    }
    OnCameraAnswer(order, answer.status);
  }
  LogNotices();
}

void NucControl::GiveUpIfUnanswered(CaptureTime time) {
  if (!triggered_at_ || time - *triggered_at_ < patience_) return;
  // The answer may still come; it is then skipped above.
  ++answers_too_late_;
  OnCameraAnswer(
      NucOrder::kTrigger,
      Unavailable(fmt::format("the camera did not answer within {:.1f} s", ToSeconds(patience_))));
}

void NucControl::OnCameraAnswer(NucOrder order, const Status& answer) {
  supervisor_.OnAnswer(order, answer);
  if (order != NucOrder::kTrigger) return;
  triggered_at_.reset();
  for (const std::uint64_t number : std::exchange(waiting_, {})) {
    Answer(number, OutcomeOfOrder(answer),
           answer.ok() ? "the camera has the order" : answer.message());
  }
}

void NucControl::Execute(const Command& command) {
  Result<std::string> done = std::string();
  switch (command.kind) {
    case CommandKind::kTriggerNuc:
      done = supervisor_.Request();
      // How the camera takes the order is known only when it has answered.
      if (done && done->empty()) return waiting_.push_back(command.number);
      break;
    case CommandKind::kHoldNuc:
      done = supervisor_.Hold(command.hold_s);
      break;
    case CommandKind::kSetNucPolicy:
      if (const Status set = supervisor_.SetPolicy(command.nuc_policy); !set.ok()) done = Err(set);
      break;
    default:
      done = Err(InvalidArgument("not a command about the NUC"));
  }
  LogNotices();
  Answer(command.number, done ? CommandOutcome::kDone : CommandOutcome::kRefused,
         done ? *done : done.error().message());
}

void NucControl::End() {
  for (const std::uint64_t number : std::exchange(waiting_, {}))
    Answer(number, CommandOutcome::kFailed, "the source has ended");
}

void NucControl::Answer(std::uint64_t number, CommandOutcome outcome, std::string text) {
  answers_.push_back({number, outcome, std::move(text)});
}

void NucControl::LogNotices() {
  for (NucNotice& notice : supervisor_.TakeNotices()) {
    if (IsLogged(notice.level)) WriteLog(notice.level, "Nuc", notice.text);
    log_.push_back({notice.time, LevelName(notice.level), "nuc: " + notice.text});
  }
}

NucReport NucControl::Report() const {
  constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
  NucReport report;
  report.state = status_.state;
  report.source = status_.source;
  report.policy = supervisor_.policy();
  report.seconds_since = status_.seconds_since_nuc.value_or(kUnknown);
  report.closings_per_minute =
      static_cast<std::uint32_t>(supervisor_.shutter().closings_per_minute());
  report.closed_fraction = supervisor_.shutter().closed_fraction();
  report.storm = supervisor_.is_storm();
  report.warming_up = supervisor_.is_warming_up();
  report.fpa_celsius = static_cast<double>(housekeeping_.fpa_celsius);
  report.housing_celsius = static_cast<double>(housekeeping_.housing_celsius);
  report.reason = supervisor_.reason();
  return report;
}

}  // namespace isotherm
