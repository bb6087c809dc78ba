#include <isotherm_control.h>

#include <algorithm>
#include <span>

#include "common/transport/bounded_text.h"
#include "common/transport/conversions.h"
#include "common/transport/sample_validator.h"
#include "common/transport/wire_pose.h"
#include "common/transport/wire_sequence.h"

namespace isotherm {
namespace {

void ToWireReceipt(const StreamReceipt& from, isotherm_wire_StreamReceipt* to) {
  to->next_number = from.next;
  to->handled = from.handled;
  to->received = from.received;
  const std::size_t skipped = from.holes.size() - std::min(from.holes.size(), kMaxHoles);
  const auto holes = Allocate(&to->holes, from.holes.size(), kMaxHoles);
  for (std::size_t i = 0; i < holes.size(); ++i) {
    const FrameRange& hole = from.holes[skipped + i];  // The newest matter most.
    holes[i] = {.first = hole.first, .last = hole.last};
  }
}

std::optional<RefusalCause> FromWireReceipt(const isotherm_wire_StreamReceipt& from,
                                            StreamReceipt* to) {
  to->next = from.next_number;
  to->handled = from.handled;
  to->received = from.received;
  for (const auto& hole : Elements(from.holes)) to->holes.push_back({hole.first, hole.last});
  return CheckStreamReceipt(*to);
}

isotherm_wire_CoverageShares ToWireFractions(const CoverageFractions& fractions) {
  return {.good = fractions.good,
          .acceptable = fractions.acceptable,
          .bad = fractions.bad,
          .never_measured = fractions.never_measured};
}

CoverageFractions FromWireFractions(const isotherm_wire_CoverageShares& fractions) {
  return {.good = fractions.good,
          .acceptable = fractions.acceptable,
          .bad = fractions.bad,
          .never_measured = fractions.never_measured};
}

std::optional<RefusalCause> FromWirePoses(const isotherm_wire_Feedback& from, Feedback* to) {
  if (from.has_pose) {
    to->T_world_depth = FromWirePose(from.t_world_depth);
    if (!to->T_world_depth) return RefusalCause::kOutOfRange;
  }
  if (from.has_next_pose) {
    to->T_world_depth_next = FromWirePose(from.t_world_depth_next);
    if (!to->T_world_depth_next) return RefusalCause::kOutOfRange;
  }
  if (from.has_next_in_depth) {
    to->T_depth_next = FromWirePose(from.t_depth_next);
    if (!to->T_depth_next) return RefusalCause::kOutOfRange;
  }
  return std::nullopt;
}

/// Numbers of the upper triangle of a 6 x 6 matrix. They cross the link as floats: Cyclone DDS
/// 0.10.2 checks a sequence of 8-byte elements only up to half of its length.
constexpr std::size_t kCovarianceNumbers = 21;

/// The upper triangle, row by row.
void ToWireCovariance(const PoseCovariance& from, std::span<float> to) {
  std::size_t k = 0;
  for (int i = 0; i < 6; ++i) {
    for (int j = i; j < 6; ++j) to[k++] = static_cast<float>(from(i, j));
  }
}

PoseCovariance FromWireCovariance(std::span<const float> from) {
  PoseCovariance to;
  std::size_t k = 0;
  for (int i = 0; i < 6; ++i) {
    for (int j = i; j < 6; ++j) to(i, j) = to(j, i) = from[k++];
  }
  return to;
}

std::optional<RefusalCause> FromWireLists(const isotherm_wire_Feedback& from, Feedback* to) {
  for (const std::uint8_t advice : Elements(from.advice)) {
    if (const auto cause = CheckEnum(advice, Advice::kDone)) return cause;
    to->advice.push_back(static_cast<Advice>(advice));
  }
  for (const auto& latency : Elements(from.latencies)) {
    to->latencies.push_back(
        {.stage = ReadText(latency.stage), .p50_s = latency.p50_s, .p99_s = latency.p99_s});
  }
  const auto image = Elements(from.confidence_image);
  to->image.assign(image.begin(), image.end());
  return std::nullopt;
}

}  // namespace

void ToWire(const Command& from, isotherm_wire_Command* to) {
  to->number = from.number;
  to->time_ns = ToNanoseconds(from.time);
  to->kind = static_cast<std::uint8_t>(from.kind);
  to->nuc_policy = static_cast<std::uint8_t>(from.nuc_policy);
  to->publish_policy = static_cast<std::uint8_t>(from.publish_policy);
  to->hold_s = from.hold_s;
  CopyText(from.text, to->mark_text);
}

std::optional<RefusalCause> FromWire(const isotherm_wire_Command& from, Command* to) {
  if (from.time_ns < 0) return RefusalCause::kNegativeTime;
  if (const auto cause = CheckEnum(from.kind, CommandKind::kMark)) return cause;
  if (const auto cause = CheckEnum(from.nuc_policy, NucPolicy::kCamera)) return cause;
  if (const auto cause = CheckFinite({from.hold_s})) return cause;
  if (const auto cause = CheckEnum(from.publish_policy, PublishPolicy::kLossless)) return cause;
  *to = {.number = from.number,
         .time = CaptureTimeFromNanoseconds(from.time_ns),
         .kind = static_cast<CommandKind>(from.kind),
         .nuc_policy = static_cast<NucPolicy>(from.nuc_policy),
         .publish_policy = static_cast<PublishPolicy>(from.publish_policy),
         .hold_s = from.hold_s,
         .text = ReadText(from.mark_text)};
  return std::nullopt;
}

void ToWire(const CommandResult& from, isotherm_wire_CommandResult* to) {
  to->number = from.number;
  to->outcome = static_cast<std::uint8_t>(from.outcome);
  CopyText(from.text, to->text);
}

std::optional<RefusalCause> FromWire(const isotherm_wire_CommandResult& from, CommandResult* to) {
  if (const auto cause = CheckEnum(from.outcome, CommandOutcome::kFailed)) return cause;
  *to = {.number = from.number,
         .outcome = static_cast<CommandOutcome>(from.outcome),
         .text = ReadText(from.text)};
  return std::nullopt;
}

void ToWire(const Receipt& from, isotherm_wire_Receipt* to) {
  to->session = from.session;
  ToWireReceipt(from.depth, &to->depth);
  ToWireReceipt(from.thermal, &to->thermal);
  to->clock_ping = from.clock_ping;
  to->verdict = static_cast<std::uint8_t>(from.verdict);
}

std::optional<RefusalCause> FromWire(const isotherm_wire_Receipt& from, Receipt* to) {
  to->session = from.session;
  to->clock_ping = from.clock_ping;
  // Each enum is checked against its last value before the cast: others would be undefined.
  if (const auto cause = CheckEnum(from.verdict, SessionVerdict::kOtherRig)) return cause;
  to->verdict = static_cast<SessionVerdict>(from.verdict);
  if (const auto cause = FromWireReceipt(from.depth, &to->depth)) return cause;
  return FromWireReceipt(from.thermal, &to->thermal);
}

void ToWire(const Feedback& from, isotherm_wire_Feedback* to) {
  to->session = from.session;
  to->frame_number = from.frame_number;
  to->capture_time_ns = ToNanoseconds(from.capture_time);
  to->tracking_state = static_cast<std::uint8_t>(from.tracking_state);
  to->has_pose = from.T_world_depth.has_value();
  if (from.T_world_depth) to->t_world_depth = ToWirePose(*from.T_world_depth);
  to->covered_area_m2 = from.covered_area_m2;
  to->model = ToWireFractions(from.model);
  to->view = ToWireFractions(from.view);
  to->has_next_pose = from.T_world_depth_next.has_value();
  if (from.T_world_depth_next) to->t_world_depth_next = ToWirePose(*from.T_world_depth_next);
  const auto advice = Allocate(&to->advice, from.advice.size(), kMaxAdvice);
  std::transform(from.advice.begin(), from.advice.begin() + std::ssize(advice), advice.begin(),
                 [](Advice value) { return static_cast<std::uint8_t>(value); });
  // An image that is cut is no image.
  if (from.image.size() <= kMaxConfidenceImageBytes) {
    std::ranges::copy(
        from.image,
        Allocate(&to->confidence_image, from.image.size(), kMaxConfidenceImageBytes).begin());
  }
  const auto latencies = Allocate(&to->latencies, from.latencies.size(), kMaxStageLatencies);
  for (std::size_t i = 0; i < latencies.size(); ++i) {
    CopyText(from.latencies[i].stage, latencies[i].stage);
    latencies[i].p50_s = from.latencies[i].p50_s;
    latencies[i].p99_s = from.latencies[i].p99_s;
  }
  if (from.pose_covariance) {
    ToWireCovariance(*from.pose_covariance,
                     Allocate(&to->pose_covariance, kCovarianceNumbers, kCovarianceNumbers));
  }
  CopyText(from.advice_reason, to->advice_reason);
  to->done = from.done;
  to->has_next_in_depth = from.T_depth_next.has_value();
  if (from.T_depth_next) to->t_depth_next = ToWirePose(*from.T_depth_next);
  to->next_gain_m2 = from.next_gain_m2;
  to->frames_left_out = from.frames_left_out;
  CopyText(from.link, to->link);
}

std::optional<RefusalCause> FromWire(const isotherm_wire_Feedback& from, Feedback* to) {
  if (const auto cause = CheckEnum(from.tracking_state, TrackingState::kLost)) return cause;
  if (const auto cause = FromWirePoses(from, to)) return cause;
  if (const auto cause = FromWireLists(from, to)) return cause;
  to->session = from.session;
  to->frame_number = from.frame_number;
  to->capture_time = CaptureTimeFromNanoseconds(from.capture_time_ns);
  to->tracking_state = static_cast<TrackingState>(from.tracking_state);
  to->covered_area_m2 = from.covered_area_m2;
  to->model = FromWireFractions(from.model);
  to->view = FromWireFractions(from.view);
  const std::span<const float> covariance = Elements(from.pose_covariance);
  // An empty list is a ground that does not know it, or one of an earlier minor version.
  if (!covariance.empty() && covariance.size() != kCovarianceNumbers)
    return RefusalCause::kOutOfRange;
  if (!covariance.empty()) to->pose_covariance = FromWireCovariance(covariance);
  to->advice_reason = ReadText(from.advice_reason);
  to->done = from.done;
  to->next_gain_m2 = from.next_gain_m2;
  to->frames_left_out = from.frames_left_out;
  to->link = ReadText(from.link);
  return CheckFeedback(*to);
}

void ToWire(const Hello& from, isotherm_wire_Hello* to) {
  to->role = static_cast<std::uint8_t>(from.role);
  to->wire_major = from.wire_major;
  to->wire_minor = from.wire_minor;
  CopyText(from.software_version, to->software_version);
  CopyText(from.host, to->host);
}

std::optional<RefusalCause> FromWire(const isotherm_wire_Hello& from, Hello* to) {
  if (const auto cause = CheckEnum(from.role, Role::kGround)) return cause;
  *to = {.role = static_cast<Role>(from.role),
         .wire_major = from.wire_major,
         .wire_minor = from.wire_minor,
         .software_version = ReadText(from.software_version),
         .host = ReadText(from.host)};
  return std::nullopt;
}

}  // namespace isotherm
