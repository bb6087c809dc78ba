#include <isotherm_control.h>

#include <algorithm>
#include <span>

#include "common/transport/bounded_text.h"
#include "common/transport/conversions.h"
#include "common/transport/sample_validator.h"
#include "common/transport/wire_pose.h"

namespace isotherm {
namespace {

/// Allocates a list for at most `max` of `count` elements in a zeroed wire sequence; returns its
/// elements.
template <typename Sequence>
auto Allocate(Sequence* sequence, std::size_t count, std::size_t max) {
  using Element = std::remove_pointer_t<decltype(sequence->_buffer)>;
  const std::size_t length = std::min(count, max);
  if (length > 0) {
    sequence->_buffer = static_cast<Element*>(dds_alloc(length * sizeof(Element)));  // Zeroed.
  }
  sequence->_maximum = static_cast<std::uint32_t>(length);
  sequence->_length = static_cast<std::uint32_t>(length);
  sequence->_release = true;
  return std::span<Element>(sequence->_buffer, length);
}

template <typename Sequence>
auto Elements(const Sequence& sequence) {
  using Element = std::remove_pointer_t<decltype(sequence._buffer)>;
  return std::span<const Element>(sequence._buffer, sequence._length);
}

void ToWireStream(const StreamStatus& from, isotherm_wire_StreamStatus* to) {
  to->captured = from.captured;
  to->published = from.published;
  to->next_frame_number = from.next_frame_number;
  to->rate_hz = from.rate_hz;
  to->queue_frames = from.queue_frames;
  const auto dropped = Allocate(&to->dropped, from.dropped.size(), kMaxDropReasons);
  for (std::size_t i = 0; i < dropped.size(); ++i) {
    CopyText(from.dropped[i].reason, dropped[i].reason);
    dropped[i].frames = from.dropped[i].frames;
  }
}

std::optional<RefusalCause> FromWireStream(const isotherm_wire_StreamStatus& from,
                                           StreamStatus* to) {
  if (from.next_frame_number > kMaxFrameNumber + 1 || from.published > from.next_frame_number) {
    return RefusalCause::kImpossibleNumber;
  }
  if (const auto cause = CheckFinite({from.rate_hz})) return cause;
  to->captured = from.captured;
  to->published = from.published;
  to->next_frame_number = from.next_frame_number;
  to->rate_hz = from.rate_hz;
  to->queue_frames = from.queue_frames;
  for (const auto& dropped : Elements(from.dropped)) {
    to->dropped.push_back({.reason = ReadText(dropped.reason), .frames = dropped.frames});
  }
  return std::nullopt;
}

void ToWireCamera(const CameraReport& from, isotherm_wire_CameraReport* to) {
  to->state = static_cast<std::uint8_t>(from.state);
  to->failures = from.failures;
  to->stamping_p50_s = from.stamping_p50_s;
  to->stamping_p99_s = from.stamping_p99_s;
}

std::optional<RefusalCause> FromWireCamera(const isotherm_wire_CameraReport& from,
                                           CameraReport* to) {
  if (const auto cause = CheckEnum(from.state, CameraState::kBlind)) return cause;
  if (const auto cause = CheckFiniteOrUnknown({from.stamping_p50_s, from.stamping_p99_s})) {
    return cause;
  }
  *to = {static_cast<CameraState>(from.state), from.failures, from.stamping_p50_s,
         from.stamping_p99_s};
  return std::nullopt;
}

void ToWireNuc(const NucReport& from, isotherm_wire_EdgeStatus* to) {
  to->nuc_state = static_cast<std::uint8_t>(from.state);
  to->has_nuc = true;
  to->nuc_source = static_cast<std::uint8_t>(from.source);
  to->nuc_policy = static_cast<std::uint8_t>(from.policy);
  to->nuc_seconds_since = from.seconds_since;
  to->nuc_closings_per_minute = from.closings_per_minute;
  to->nuc_closed_share = from.closed_share;
  to->nuc_storm = from.storm;
  to->nuc_warming_up = from.warming_up;
  to->nuc_fpa_celsius = from.fpa_celsius;
  to->nuc_housing_celsius = from.housing_celsius;
  CopyText(from.reason, to->nuc_reason);
}

std::optional<RefusalCause> FromWireNuc(const isotherm_wire_EdgeStatus& from, NucReport* to) {
  if (const auto cause = CheckEnum(from.nuc_state, NucState::kError)) return cause;
  to->state = static_cast<NucState>(from.nuc_state);
  if (!from.has_nuc) return std::nullopt;
  if (const auto cause = CheckEnum(from.nuc_source, NucSource::kInferred)) return cause;
  if (const auto cause = CheckEnum(from.nuc_policy, NucPolicy::kCamera)) return cause;
  const auto infinite = CheckFiniteOrUnknown({from.nuc_seconds_since, from.nuc_closed_share,
                                              from.nuc_fpa_celsius, from.nuc_housing_celsius});
  if (infinite) return infinite;
  to->source = static_cast<NucSource>(from.nuc_source);
  to->policy = static_cast<NucPolicy>(from.nuc_policy);
  to->seconds_since = from.nuc_seconds_since;
  to->closings_per_minute = from.nuc_closings_per_minute;
  to->closed_share = from.nuc_closed_share;
  to->storm = from.nuc_storm;
  to->warming_up = from.nuc_warming_up;
  to->fpa_celsius = from.nuc_fpa_celsius;
  to->housing_celsius = from.nuc_housing_celsius;
  to->reason = ReadText(from.nuc_reason);
  return std::nullopt;
}

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

isotherm_wire_CoverageShares ToWireShares(const CoverageShares& shares) {
  return {.good = shares.good,
          .acceptable = shares.acceptable,
          .bad = shares.bad,
          .never_measured = shares.never_measured};
}

CoverageShares FromWireShares(const isotherm_wire_CoverageShares& shares) {
  return {.good = shares.good,
          .acceptable = shares.acceptable,
          .bad = shares.bad,
          .never_measured = shares.never_measured};
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

/// The upper triangle, row by row.
void ToWireCovariance(const PoseCovariance& from, double (&to)[21]) {
  std::size_t k = 0;
  for (int i = 0; i < 6; ++i) {
    for (int j = i; j < 6; ++j) to[k++] = from(i, j);
  }
}

PoseCovariance FromWireCovariance(const double (&from)[21]) {
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
  const auto picture = Elements(from.picture);
  to->picture.assign(picture.begin(), picture.end());
  return std::nullopt;
}

}  // namespace

void ToWire(const EdgeStatus& from, isotherm_wire_EdgeStatus* to) {
  to->session = from.session;
  to->time_ns = ToNanoseconds(from.time);
  to->scan_state = static_cast<std::uint8_t>(from.scan_state);
  to->publish_policy = static_cast<std::uint8_t>(from.publish_policy);
  ToWireNuc(from.nuc, to);
  ToWireStream(from.depth, &to->depth);
  ToWireStream(from.thermal, &to->thermal);
  to->spool_fill_ratio = from.spool_fill_ratio;
  to->spool_frames = from.spool_frames;
  to->clock_offset_s = from.clock_offset_s;
  to->clock_error_s = from.clock_error_s;
  to->disk_free_bytes = from.disk_free_bytes;
  to->cpu_temperature_celsius = from.cpu_temperature_celsius;
  to->feedback_count = from.feedback.count;
  to->feedback_latency_p50_s = from.feedback.p50_s;
  to->feedback_latency_p99_s = from.feedback.p99_s;
  ToWireCamera(from.depth_camera, &to->depth_camera);
  ToWireCamera(from.thermal_camera, &to->thermal_camera);
}

std::optional<RefusalCause> FromWire(const isotherm_wire_EdgeStatus& from, EdgeStatus* to) {
  if (from.time_ns < 0) return RefusalCause::kNegativeTime;
  if (const auto cause = CheckEnum(from.scan_state, ScanState::kEnded)) return cause;
  if (const auto cause = CheckEnum(from.publish_policy, PublishPolicy::kLossless)) return cause;
  if (const auto cause = FromWireNuc(from, &to->nuc)) return cause;
  const auto infinite = CheckFiniteOrUnknown(
      {from.spool_fill_ratio, from.clock_offset_s, from.clock_error_s, from.cpu_temperature_celsius,
       from.feedback_latency_p50_s, from.feedback_latency_p99_s});
  if (infinite) return infinite;
  if (const auto cause = FromWireStream(from.depth, &to->depth)) return cause;
  if (const auto cause = FromWireStream(from.thermal, &to->thermal)) return cause;
  if (const auto cause = FromWireCamera(from.depth_camera, &to->depth_camera)) return cause;
  if (const auto cause = FromWireCamera(from.thermal_camera, &to->thermal_camera)) return cause;
  to->session = from.session;
  to->time = CaptureTimeFromNanoseconds(from.time_ns);
  to->scan_state = static_cast<ScanState>(from.scan_state);
  to->publish_policy = static_cast<PublishPolicy>(from.publish_policy);
  to->spool_fill_ratio = from.spool_fill_ratio;
  to->spool_frames = from.spool_frames;
  to->clock_offset_s = from.clock_offset_s;
  to->clock_error_s = from.clock_error_s;
  to->disk_free_bytes = from.disk_free_bytes;
  to->cpu_temperature_celsius = from.cpu_temperature_celsius;
  to->feedback = {from.feedback_count, from.feedback_latency_p50_s, from.feedback_latency_p99_s};
  return std::nullopt;
}

void ToWire(const Command& from, isotherm_wire_Command* to) {
  to->number = from.number;
  to->time_ns = ToNanoseconds(from.time);
  to->kind = static_cast<std::uint8_t>(from.kind);
  to->nuc_policy = static_cast<std::uint8_t>(from.nuc_policy);
  to->publish_policy = static_cast<std::uint8_t>(from.publish_policy);
  to->hold_s = from.hold_s;
}

std::optional<RefusalCause> FromWire(const isotherm_wire_Command& from, Command* to) {
  if (from.time_ns < 0) return RefusalCause::kNegativeTime;
  if (const auto cause = CheckEnum(from.kind, CommandKind::kHoldNuc)) return cause;
  if (const auto cause = CheckEnum(from.nuc_policy, NucPolicy::kCamera)) return cause;
  if (const auto cause = CheckFinite({from.hold_s})) return cause;
  if (const auto cause = CheckEnum(from.publish_policy, PublishPolicy::kLossless)) return cause;
  *to = {.number = from.number,
         .time = CaptureTimeFromNanoseconds(from.time_ns),
         .kind = static_cast<CommandKind>(from.kind),
         .nuc_policy = static_cast<NucPolicy>(from.nuc_policy),
         .publish_policy = static_cast<PublishPolicy>(from.publish_policy),
         .hold_s = from.hold_s};
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
}

std::optional<RefusalCause> FromWire(const isotherm_wire_Receipt& from, Receipt* to) {
  to->session = from.session;
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
  to->model = ToWireShares(from.model);
  to->view = ToWireShares(from.view);
  to->has_next_pose = from.T_world_depth_next.has_value();
  if (from.T_world_depth_next) to->t_world_depth_next = ToWirePose(*from.T_world_depth_next);
  const auto advice = Allocate(&to->advice, from.advice.size(), kMaxAdvice);
  std::transform(from.advice.begin(), from.advice.begin() + std::ssize(advice), advice.begin(),
                 [](Advice value) { return static_cast<std::uint8_t>(value); });
  // A picture that is cut is no picture.
  if (from.picture.size() <= kMaxPictureBytes) {
    std::ranges::copy(from.picture,
                      Allocate(&to->picture, from.picture.size(), kMaxPictureBytes).begin());
  }
  const auto latencies = Allocate(&to->latencies, from.latencies.size(), kMaxStageLatencies);
  for (std::size_t i = 0; i < latencies.size(); ++i) {
    CopyText(from.latencies[i].stage, latencies[i].stage);
    latencies[i].p50_s = from.latencies[i].p50_s;
    latencies[i].p99_s = from.latencies[i].p99_s;
  }
  to->has_pose_covariance = from.pose_covariance.has_value();
  if (from.pose_covariance) ToWireCovariance(*from.pose_covariance, to->pose_covariance);
  CopyText(from.advice_reason, to->advice_reason);
  to->done = from.done;
  to->has_next_in_depth = from.T_depth_next.has_value();
  if (from.T_depth_next) to->t_depth_next = ToWirePose(*from.T_depth_next);
  to->next_gain_m2 = from.next_gain_m2;
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
  to->model = FromWireShares(from.model);
  to->view = FromWireShares(from.view);
  if (from.has_pose_covariance) to->pose_covariance = FromWireCovariance(from.pose_covariance);
  to->advice_reason = ReadText(from.advice_reason);
  to->done = from.done;
  to->next_gain_m2 = from.next_gain_m2;
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
