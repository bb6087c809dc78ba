#include "ground/console/live_convert.h"

#include <cmath>

namespace isotherm {
namespace {

void Set(const CoverageFractions& from, live::Fractions& to) {
  to.set_good(from.good);
  to.set_acceptable(from.acceptable);
  to.set_bad(from.bad);
  to.set_never_measured(from.never_measured);
}

/// In words that programs read, for symbols and sounds.
const char* KindName(Advice advice) {
  switch (advice) {
    case Advice::kMoveCloser:
      return "closer";
    case Advice::kMoveFarther:
      return "farther";
    case Advice::kLessOblique:
      return "less_oblique";
    case Advice::kMoreOblique:
      return "more_oblique";
    case Advice::kSlower:
      return "slower";
    case Advice::kHoldForNuc:
      return "hold_for_nuc";
    case Advice::kGoBackToRelocalise:
      return "go_back";
    case Advice::kDone:
      return "done";
  }
  return "";
}

}  // namespace

measuring::Vector3 ToMessage(const Eigen::Vector3d& vector) {
  measuring::Vector3 message;
  message.set_x(vector.x());
  message.set_y(vector.y());
  message.set_z(vector.z());
  return message;
}

Eigen::Vector3d FromMessage(const measuring::Vector3& vector) {
  return {vector.x(), vector.y(), vector.z()};
}

live::Pose ToMessage(const RigidTransform& pose) {
  live::Pose message;
  const Eigen::Quaterniond rotation(pose.linear());
  message.set_x(pose.translation().x());
  message.set_y(pose.translation().y());
  message.set_z(pose.translation().z());
  message.set_qx(rotation.x());
  message.set_qy(rotation.y());
  message.set_qz(rotation.z());
  message.set_qw(rotation.w());
  return message;
}

live::Camera ToMessage(const CameraModel& camera) {
  live::Camera message;
  message.set_width(static_cast<std::uint32_t>(camera.width));
  message.set_height(static_cast<std::uint32_t>(camera.height));
  message.set_fx(camera.fx);
  message.set_fy(camera.fy);
  message.set_cx(camera.cx);
  message.set_cy(camera.cy);
  return message;
}

live::Tracking ToMessage(TrackingState state) {
  switch (state) {
    case TrackingState::kTracked:
      return live::TRACKED;
    case TrackingState::kDegraded:
      return live::DEGRADED;
    case TrackingState::kLost:
      return live::LOST;
    case TrackingState::kWaiting:
      break;
  }
  return live::TRACKING_WAITING;
}

live::Guidance ToMessage(const Feedback& feedback, double done_fraction) {
  live::Guidance message;
  message.set_tracking(ToMessage(feedback.tracking_state));
  if (!feedback.advice.empty()) message.set_advice(std::string(ToString(feedback.advice.front())));
  message.set_reason(feedback.advice_reason);
  for (const Advice advice : feedback.advice) message.add_kinds(KindName(advice));
  if (!std::isnan(feedback.model.good)) Set(feedback.model, *message.mutable_model());
  if (!std::isnan(feedback.view.good)) Set(feedback.view, *message.mutable_view());
  message.set_surface_m2(feedback.covered_area_m2);
  message.set_done(feedback.done);
  message.set_done_fraction(done_fraction);
  if (feedback.T_world_depth_next)
    *message.mutable_t_world_depth_next() = ToMessage(*feedback.T_world_depth_next);
  message.set_next_gain_m2(feedback.next_gain_m2);
  message.set_frame_number(feedback.frame_number);
  return message;
}

std::optional<Command> ToCommand(const live::Order& order) {
  Command command;
  command.hold_s = order.hold_s();
  switch (order.kind()) {
    case live::Order::START_SCAN:
      command.kind = CommandKind::kStartScan;
      return command;
    case live::Order::STOP_SCAN:
      command.kind = CommandKind::kStopScan;
      return command;
    case live::Order::NUC_NOW:
      command.kind = CommandKind::kTriggerNuc;
      return command;
    case live::Order::HOLD_NUC:
      command.kind = CommandKind::kHoldNuc;
      return command;
    case live::Order::NUC_AUTOMATIC:
    case live::Order::NUC_MANUAL:
    case live::Order::NUC_CAMERA:
      command.kind = CommandKind::kSetNucPolicy;
      command.nuc_policy = order.kind() == live::Order::NUC_AUTOMATIC ? NucPolicy::kAutomatic
                           : order.kind() == live::Order::NUC_MANUAL  ? NucPolicy::kManual
                                                                      : NucPolicy::kCamera;
      return command;
    default:
      return std::nullopt;
  }
}

}  // namespace isotherm
