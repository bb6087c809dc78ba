#include <isotherm_control.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "common/transport/bounded_text.h"
#include "common/transport/conversions.h"
#include "common/transport/sample_validator.h"
#include "common/transport/wire_sequence.h"

namespace isotherm {
namespace {

constexpr double kMaxClockStep_s = 4.2e9;  // From 1970 to 2100, and farther than that nobody steps.

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
  // What cannot be is refused here, where it arrives, so that nobody behind has to doubt it: sums
  // of these counters are compared with what was received.
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
  to->stamp_sigma_s = from.stamp_sigma_s;
  to->unsynchronised_frames = from.unsynchronised_frames;
}

std::optional<RefusalCause> FromWireCamera(const isotherm_wire_CameraReport& from,
                                           CameraReport* to) {
  if (const auto cause = CheckEnum(from.state, CameraState::kBlind)) return cause;
  const auto infinite =
      CheckFiniteOrUnknown({from.stamping_p50_s, from.stamping_p99_s, from.stamp_sigma_s});
  if (infinite) return infinite;
  // NaN passes: it is not known.
  if (from.stamp_sigma_s < 0.0) return RefusalCause::kOutOfRange;
  *to = {.state = static_cast<CameraState>(from.state),
         .failures = from.failures,
         .stamping_p50_s = from.stamping_p50_s,
         .stamping_p99_s = from.stamping_p99_s,
         .stamp_sigma_s = from.stamp_sigma_s,
         .unsynchronised_frames = from.unsynchronised_frames};
  return std::nullopt;
}

void ToWireClock(const EdgeStatus& from, isotherm_wire_EdgeStatus* to) {
  to->clock_offset_s = from.clock.offset_s;
  to->clock_error_s = from.clock.max_error_s;
  to->clock_synchronised = from.clock.synchronised;
  to->clock_estimated_error_s = from.clock.estimated_error_s;
  to->clock_steps = from.clock.steps;
  to->clock_step_sum_s = from.clock.step_sum_s;
  if (!from.clock_echo) return;
  to->echo_ping = from.clock_echo->ping;
  to->echo_received_ns = ToNanoseconds(from.clock_echo->received);
  to->echo_sent_ns = ToNanoseconds(from.clock_echo->sent);
}

std::optional<RefusalCause> FromWireClock(const isotherm_wire_EdgeStatus& from, EdgeStatus* to) {
  const auto infinite =
      CheckFiniteOrUnknown({from.clock_offset_s, from.clock_error_s, from.clock_estimated_error_s});
  if (infinite) return infinite;
  if (const auto cause = CheckFinite({from.clock_step_sum_s})) return cause;
  if (from.clock_error_s < 0.0 || from.clock_estimated_error_s < 0.0 ||
      std::abs(from.clock_step_sum_s) > kMaxClockStep_s) {
    return RefusalCause::kOutOfRange;
  }
  to->clock = {.synchronised = from.clock_synchronised,
               .offset_s = from.clock_offset_s,
               .estimated_error_s = from.clock_estimated_error_s,
               .max_error_s = from.clock_error_s,
               .steps = from.clock_steps,
               .step_sum_s = from.clock_step_sum_s};
  // An edge that has not been asked, or is older than the question, sends zeros.
  if (from.echo_ping == 0) return std::nullopt;
  if (const auto cause = CheckClockTime(from.echo_received_ns)) return cause;
  if (const auto cause = CheckClockTime(from.echo_sent_ns)) return cause;
  to->clock_echo = {.ping = from.echo_ping,
                    .received = CaptureTimeFromNanoseconds(from.echo_received_ns),
                    .sent = CaptureTimeFromNanoseconds(from.echo_sent_ns)};
  return std::nullopt;
}

void ToWireNuc(const NucReport& from, isotherm_wire_EdgeStatus* to) {
  to->nuc_state = static_cast<std::uint8_t>(from.state);
  to->nuc_source = static_cast<std::uint8_t>(from.source);
  to->nuc_policy = static_cast<std::uint8_t>(from.policy);
  to->nuc_seconds_since = from.seconds_since;
  to->nuc_closings_per_minute = from.closings_per_minute;
  // The wire keeps its old word until its next major version: members are compared by name before
  // two versions talk.
  to->nuc_closed_share = from.closed_fraction;
  to->nuc_storm = from.storm;
  to->nuc_warming_up = from.warming_up;
  to->nuc_fpa_celsius = from.fpa_celsius;
  to->nuc_housing_celsius = from.housing_celsius;
  CopyText(from.reason, to->nuc_reason);
}

std::optional<RefusalCause> FromWireNuc(const isotherm_wire_EdgeStatus& from, NucReport* to) {
  if (const auto cause = CheckEnum(from.nuc_state, NucState::kError)) return cause;
  to->state = static_cast<NucState>(from.nuc_state);
  if (const auto cause = CheckEnum(from.nuc_source, NucSource::kInferred)) return cause;
  if (const auto cause = CheckEnum(from.nuc_policy, NucPolicy::kCamera)) return cause;
  const auto infinite = CheckFiniteOrUnknown({from.nuc_seconds_since, from.nuc_closed_share,
                                              from.nuc_fpa_celsius, from.nuc_housing_celsius});
  if (infinite) return infinite;
  to->source = static_cast<NucSource>(from.nuc_source);
  to->policy = static_cast<NucPolicy>(from.nuc_policy);
  to->seconds_since = from.nuc_seconds_since;
  to->closings_per_minute = from.nuc_closings_per_minute;
  to->closed_fraction = from.nuc_closed_share;
  to->storm = from.nuc_storm;
  to->warming_up = from.nuc_warming_up;
  to->fpa_celsius = from.nuc_fpa_celsius;
  to->housing_celsius = from.nuc_housing_celsius;
  to->reason = ReadText(from.nuc_reason);
  return std::nullopt;
}

void ToWireMarks(const EdgeStatus& from, isotherm_wire_EdgeStatus* to) {
  const std::size_t skipped = from.marks.size() - std::min(from.marks.size(), kMaxMarks);
  const auto marks = Allocate(&to->scan_marks, from.marks.size(), kMaxMarks);
  for (std::size_t i = 0; i < marks.size(); ++i) {
    const ScanMark& mark = from.marks[skipped + i];  // The newest: the others were sent before.
    marks[i].time_ns = ToNanoseconds(mark.time);
    CopyText(mark.text, marks[i].text);
  }
}

std::optional<RefusalCause> FromWireMarks(const isotherm_wire_EdgeStatus& from, EdgeStatus* to) {
  for (const auto& mark : Elements(from.scan_marks)) {
    if (mark.time_ns < 0) return RefusalCause::kNegativeTime;
    to->marks.push_back({CaptureTimeFromNanoseconds(mark.time_ns), ReadText(mark.text)});
  }
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
  ToWireClock(from, to);
  to->disk_free_bytes = from.disk_free_bytes;
  to->cpu_temperature_celsius = from.cpu_temperature_celsius;
  to->feedback_count = from.feedback.count;
  to->feedback_latency_p50_s = from.feedback.p50_s;
  to->feedback_latency_p99_s = from.feedback.p99_s;
  ToWireCamera(from.depth_camera, &to->depth_camera);
  ToWireCamera(from.thermal_camera, &to->thermal_camera);
  ToWireMarks(from, to);
  to->served_ground = from.served_ground;
  to->spool_bytes = from.spool_bytes;
  to->frames_gone = from.frames_gone;
  to->spool_keeps_s = from.spool_keeps_s;
}

std::optional<RefusalCause> FromWire(const isotherm_wire_EdgeStatus& from, EdgeStatus* to) {
  // Numbers and enumerations first, and nothing is allocated before they are right.
  if (const auto cause = CheckClockTime(from.time_ns)) return cause;
  if (const auto cause = CheckEnum(from.scan_state, ScanState::kEnded)) return cause;
  if (const auto cause = CheckEnum(from.publish_policy, PublishPolicy::kLossless)) return cause;
  if (const auto cause = FromWireNuc(from, &to->nuc)) return cause;
  if (const auto cause = FromWireClock(from, to)) return cause;
  const auto infinite =
      CheckFiniteOrUnknown({from.spool_fill_ratio, from.spool_keeps_s, from.cpu_temperature_celsius,
                            from.feedback_latency_p50_s, from.feedback_latency_p99_s});
  if (infinite) return infinite;
  if (const auto cause = FromWireStream(from.depth, &to->depth)) return cause;
  if (const auto cause = FromWireStream(from.thermal, &to->thermal)) return cause;
  if (const auto cause = FromWireCamera(from.depth_camera, &to->depth_camera)) return cause;
  if (const auto cause = FromWireCamera(from.thermal_camera, &to->thermal_camera)) return cause;
  if (const auto cause = FromWireMarks(from, to)) return cause;
  to->session = from.session;
  to->served_ground = from.served_ground;
  to->spool_bytes = from.spool_bytes;
  to->frames_gone = from.frames_gone;
  to->spool_keeps_s = from.spool_keeps_s;
  to->time = CaptureTimeFromNanoseconds(from.time_ns);
  to->scan_state = static_cast<ScanState>(from.scan_state);
  to->publish_policy = static_cast<PublishPolicy>(from.publish_policy);
  to->spool_fill_ratio = from.spool_fill_ratio;
  to->spool_frames = from.spool_frames;
  to->disk_free_bytes = from.disk_free_bytes;
  to->cpu_temperature_celsius = from.cpu_temperature_celsius;
  to->feedback = {from.feedback_count, from.feedback_latency_p50_s, from.feedback_latency_p99_s};
  return std::nullopt;
}

}  // namespace isotherm
