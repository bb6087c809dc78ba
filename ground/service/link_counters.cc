#include "ground/service/link_counters.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string_view>

#include "common/base/units.h"
#include "common/messages/backlog.h"
#include "ground/subscriber/clock_watch.h"

namespace isotherm {
namespace {

std::string InUnderscores(std::string_view words) {
  std::string name(words);
  std::ranges::replace(name, ' ', '_');
  return name;
}

Json DescribeStream(const StreamCounters& counters, std::uint64_t recorded,
                    const NotRecordedCounts& left_out) {
  Json json;
  json["published"] = counters.published;
  json["received"] = counters.received;
  json["missing"] = counters.missing;
  json["late"] = counters.late;
  json["duplicates"] = counters.duplicates;
  json["refused"] = counters.refused;
  for (std::size_t i = 0; i < counters.refused_by_cause.size(); ++i) {
    if (counters.refused_by_cause[i] == 0) continue;
    json["refused_by_cause"][InUnderscores(ToString(static_cast<RefusalCause>(i)))] =
        counters.refused_by_cause[i];
  }
  for (const DropCount& drop : counters.dropped_by_rig) {
    json["dropped_by_rig"][InUnderscores(drop.reason)] = drop.frames;
  }
  if (counters.captured_by_rig > 0) json["captured_by_rig"] = counters.captured_by_rig;
  json["recorded"] = recorded + counters.recorded_before;
  if (counters.recorded_before > 0) json["recorded_before"] = counters.recorded_before;
  for (const NotRecorded reason : AllValues<NotRecorded>()) {
    if (left_out[reason] > 0) json["not_recorded_by_reason"][ToString(reason)] = left_out[reason];
  }
  return json;
}

std::string LackText(std::uint64_t frames, const std::string& why) {
  if (frames == 0) return {};
  return fmt::format("         {} frames are not in the recording{}\n", frames, why);
}

/// Returns what the recording lacks and why, or nothing.
std::string RecordingText(const RecordingProgress& recording) {
  std::string text = LackText(recording.left_out(NotRecorded::kDiskTooSlow),
                              ", because the disk did not take them in time") +
                     LackText(recording.left_out(NotRecorded::kDiskNearlyFull),
                              ": what was left of the disk was kept for the results") +
                     LackText(recording.left_out(NotRecorded::kDiskFailed),
                              ", because the disk failed: " + recording.disk_error.message()) +
                     LackText(recording.left_out(NotRecorded::kUnwritable),
                              ", because they are wrong; the log says how");
  if (recording.files.size() > 1) {
    text += fmt::format("         the recording has {} files, up to {}\n", recording.files.size(),
                        recording.files.back().string());
  }
  // Results do not wait for a stuck disk; the recording may still be whole in the end.
  if (!recording.path.empty() && !recording.closed)
    text += "         the recording is not finished: the disk is slow or stuck\n";
  return text;
}

/// Returns what never left the rig and why, or nothing.
std::string RigText(const StreamCounters& counters) {
  std::string reasons;
  std::uint64_t frames = 0;
  for (const DropCount& drop : counters.dropped_by_rig) {
    frames += drop.frames;
    reasons += fmt::format("{}{} {}", reasons.empty() ? "" : ", ", drop.reason, drop.frames);
  }
  if (frames == 0) return {};
  return fmt::format("         the rig dropped {} of {} captured: {}\n", frames,
                     counters.captured_by_rig, reasons);
}

std::string StreamText(const char* name, const StreamCounters& counters, std::uint64_t recorded) {
  std::string text = fmt::format("{:<8} {} published = {} received + {} missing; {} recorded", name,
                                 counters.published, counters.received, counters.missing,
                                 recorded + counters.recorded_before);
  if (counters.late > 0) text += fmt::format("; {} came late", counters.late);
  if (counters.refused > 0) text += fmt::format("; {} samples refused", counters.refused);
  return text + "\n" + RigText(counters);
}

/// Returns whether frames that did not arrive are in the rig's recording: it is written beside the
/// link, so that it has also what found no room before the link.
bool IsAnyOnTheRigOnly(const StreamCounters& counters) {
  return counters.missing > 0 ||
         std::ranges::any_of(counters.dropped_by_rig, [](const DropCount& drop) {
           return (drop.reason == "queue full" || drop.reason == kLeftForLater) && drop.frames > 0;
         });
}

/// Says where what did not arrive is to be had.
std::string MissingText(const SessionCounters& counters, const RecordingProgress& recording) {
  if (!IsAnyOnTheRigOnly(counters.depth) && !IsAnyOnTheRigOnly(counters.thermal)) return {};
  return fmt::format(
      "         what is missing is in the rig's recording, if it kept one: isotherm "
      "merge-recordings {} RIG.mcap -o WHOLE.mcap\n",
      recording.path.empty() ? "RECORDING.mcap" : recording.path.string());
}

void DescribeClock(const SessionClock& clock, Json& json) {
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

void DescribeCounters(const SessionCounters& counters, const RecordingProgress& recording,
                      Json& link) {
  link["depth"] = DescribeStream(counters.depth, recording.depth_frames, recording.depth_left_out);
  link["thermal"] =
      DescribeStream(counters.thermal, recording.thermal_frames, recording.thermal_left_out);
  // A stuck disk has not taken all frames yet.
  const bool waits = !recording.path.empty() && !recording.closed;
  const auto add_waiting = [&](const char* sensor, const StreamCounters& stream,
                               std::uint64_t recorded, const NotRecordedCounts& left_out) {
    const std::uint64_t settled = recorded + stream.recorded_before + Sum(left_out);
    // So that received = recorded + not recorded holds in every result.
    if (waits && stream.received > settled)
      link[sensor]["not_recorded_by_reason"]["still_waiting"] = stream.received - settled;
  };
  add_waiting("depth", counters.depth, recording.depth_frames, recording.depth_left_out);
  add_waiting("thermal", counters.thermal, recording.thermal_frames, recording.thermal_left_out);
  link["recording_failed_frames"] =
      recording.left_out(NotRecorded::kDiskFailed) + recording.left_out(NotRecorded::kUnwritable);
  for (const std::filesystem::path& file : recording.earlier_files)
    link["recording_files"].push_back(file.filename().string());
  for (const std::filesystem::path& file : recording.files)
    link["recording_files"].push_back(file.filename().string());
  link["most_lacking_frames"] = counters.most_lacking;
  for (const ScanMark& mark : counters.marks) {
    link["marks"].push_back(
        {{"time_s", ToSeconds(mark.time.time_since_epoch())}, {"text", mark.text}});
  }
  link["refused_samples"] = counters.refused_samples;
  link["recording_finished"] = recording.closed;
  if (!recording.status.ok()) link["recording_failed_because"] = recording.status.message();
  if (counters.clock) DescribeClock(*counters.clock, link["clock"]);
  Json& feedback = link["feedback"];
  feedback["received_by_edge"] = counters.feedback.count;
  if (!std::isfinite(counters.feedback.p50_s)) return;
  feedback["latency_p50_ms"] = kMsPerS * counters.feedback.p50_s;
  feedback["latency_p99_ms"] = kMsPerS * counters.feedback.p99_s;
}

std::string CountersText(const SessionCounters& counters, const RecordingProgress& recording) {
  std::string text = StreamText("link", counters.depth, recording.depth_frames) +
                     StreamText("", counters.thermal, recording.thermal_frames);
  text += MissingText(counters, recording);
  if (!counters.ended) {
    text += "         the rig had not said its last word: what it sent after these is not known\n";
  }
  text += RecordingText(recording);
  if (counters.clock)
    text += fmt::format("{:<8} of the rig: {}\n", "clock", ClockText(*counters.clock));
  if (!std::isfinite(counters.feedback.p50_s)) return text;
  return text + fmt::format(
                    "feedback {} messages, from depth capture to arrival on the edge p50 "
                    "{:.0f} ms, p99 {:.0f} ms\n",
                    counters.feedback.count, kMsPerS * counters.feedback.p50_s,
                    kMsPerS * counters.feedback.p99_s);
}

}  // namespace isotherm
