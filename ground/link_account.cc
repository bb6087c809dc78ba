#include "ground/link_account.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "ground/subscriber/clock_watch.h"

namespace isotherm {
namespace {

constexpr double kMsPerS = 1e3;

Json DescribeStream(const StreamAccount& account, std::uint64_t recorded) {
  Json json;
  json["published"] = account.published;
  json["received"] = account.received;
  json["missing"] = account.missing;
  json["late"] = account.late;
  json["duplicates"] = account.duplicates;
  json["refused"] = account.refused;
  for (std::size_t i = 0; i < account.refused_by_cause.size(); ++i) {
    if (account.refused_by_cause[i] == 0) continue;
    std::string cause(ToString(static_cast<RefusalCause>(i)));
    std::ranges::replace(cause, ' ', '_');
    json["refused_by_cause"][cause] = account.refused_by_cause[i];
  }
  json["recorded"] = recorded;
  return json;
}

std::string StreamText(const char* name, const StreamAccount& account, std::uint64_t recorded) {
  std::string text = fmt::format("{:<8} {} published = {} received + {} missing; {} recorded", name,
                                 account.published, account.received, account.missing, recorded);
  if (account.refused > 0) text += fmt::format("; {} samples refused", account.refused);
  return text + "\n";
}

void DescribeClock(const ClockAccount& clock, Json& json) {
  json["synchronised"] = clock.rig.synchronised;
  json["unsynchronised_at_some_time"] = clock.unsynchronised;
  json["correcting_ms"] = kMsPerS * clock.rig.offset_s;
  json["estimated_error_ms"] = kMsPerS * clock.rig.estimated_error_s;
  json["max_error_ms"] = kMsPerS * clock.rig.max_error_s;
  json["steps"] = clock.rig.steps;
  json["step_sum_s"] = clock.rig.step_sum_s;
  const auto describe = [&json](const char* sensor, const CameraReport& camera) {
    json["stamp_sigma_ms"][sensor] = kMsPerS * camera.stamp_sigma_s;
    json["unsynchronised_frames"][sensor] = camera.unsynchronised_frames;
  };
  describe("depth", clock.depth_camera);
  describe("thermal", clock.thermal_camera);
  Json& difference = json["minus_ground_clock"];
  if (clock.offset) {
    difference["ms"] = kMsPerS * clock.offset->offset_s;
    difference["uncertainty_ms"] = kMsPerS * clock.offset->uncertainty_s;
    difference["largest_certain_ms"] = kMsPerS * clock.largest_offset_s;
  }
  json["alarm"] = clock.alarm;
  json["alarms"] = clock.alarms;
}

}  // namespace

void DescribeAccount(const SessionAccount& account, const RecordingStats& recorded, Json& link) {
  link["depth"] = DescribeStream(account.depth, recorded.depth_frames);
  link["thermal"] = DescribeStream(account.thermal, recorded.thermal_frames);
  link["recording_failed_frames"] = recorded.failed;
  link["refused_samples"] = account.refused_samples;
  if (account.clock) DescribeClock(*account.clock, link["clock"]);
  Json& feedback = link["feedback"];
  feedback["received_by_edge"] = account.feedback.count;
  if (!std::isfinite(account.feedback.p50_s)) return;
  feedback["latency_p50_ms"] = kMsPerS * account.feedback.p50_s;
  feedback["latency_p99_ms"] = kMsPerS * account.feedback.p99_s;
}

std::string AccountText(const SessionAccount& account, const RecordingStats& recorded) {
  std::string text = StreamText("link", account.depth, recorded.depth_frames) +
                     StreamText("", account.thermal, recorded.thermal_frames);
  if (account.clock)
    text += fmt::format("{:<8} of the rig: {}\n", "clock", ClockText(*account.clock));
  if (!std::isfinite(account.feedback.p50_s)) return text;
  return text + fmt::format(
                    "feedback {} messages, from depth capture to arrival on the edge p50 "
                    "{:.0f} ms, p99 {:.0f} ms\n",
                    account.feedback.count, kMsPerS * account.feedback.p50_s,
                    kMsPerS * account.feedback.p99_s);
}

}  // namespace isotherm
