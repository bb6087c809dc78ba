#include <nlohmann/json.hpp>

#include "common/dataset/text_lines.h"
#include "common/rig/rig_calibration.h"
#include "common/rig/rig_calibration.pb.h"
#include "ground/cli/recording_damage.h"
#include "ground/cli/recording_report.h"
#include "ground/json/message_json.h"

namespace isotherm {
namespace {

Json StreamJson(const StreamSummary& stream) {
  Json json;
  json["frames"] = stream.frames;
  if (stream.frames == 0) return json;
  json["width"] = stream.sizes.begin()->first;
  json["height"] = stream.sizes.begin()->second;
  json["sizes"] = stream.sizes.size();
  json["first"] = FormatStamp(stream.first);
  json["last"] = FormatStamp(stream.last);
  json["rate_hz"] = stream.rate_hz();
  json["missing"] = stream.missing;
  json["holes"] = stream.holes;
  json["duplicates"] = stream.duplicates;
  json["out_of_order"] = stream.out_of_order;
  json["gaps"] = stream.gaps;
  json["longest_gap_s"] = stream.longest_gap_s;
  json["repeats"] = stream.repeats;
  json["sessions"] = stream.sessions.size();
  json["capture_sigma_s"] = stream.sigma_s;
  for (const auto& [name, count] : stream.encodings) json["encodings"][name] = count;
  json["raw_bytes"] = stream.raw_bytes;
  json["payload_bytes"] = stream.payload_bytes;
  json["compression"] = stream.compression();
  return json;
}

Json NucJson(const RecordingSummary& summary) {
  Json json;
  json["valid_frames"] = summary.valid_thermal;
  for (const auto& [name, count] : summary.nuc_states) json["states"][name] = count;
  for (const NucRun& run : summary.nuc_runs) {
    Json closed;
    closed["start"] = FormatStamp(run.start);
    closed["end"] = FormatStamp(run.end);
    closed["frames"] = run.frames;
    json["closed"].push_back(std::move(closed));
  }
  for (const NucEvent& event : summary.nuc_events) {
    Json item;
    item["start"] = FormatStamp(event.start);
    item["end"] = FormatStamp(event.end);
    json["events"].push_back(std::move(item));
  }
  return json;
}

Json GapsJson(const std::vector<RecordingGap>& gaps) {
  Json json;
  for (const RecordingGap& gap : gaps) {
    Json item;
    item["offset"] = gap.offset;
    item["bytes"] = gap.bytes;
    for (const auto& [topic, count] : gap.messages_by_topic) item["messages"][topic] = count;
    json.push_back(std::move(item));
  }
  return json;
}

Json ClockJson(const RecordingReport& report) {
  Json json;
  if (const std::string state = ClockState(report.info); !state.empty()) json["state"] = state;
  for (const ClockStep& step : report.summary.clock_steps) {
    Json item;
    item["time"] = FormatStamp(step.time);
    item["step_s"] = ToSeconds(step.step);
    item["utc_minus_capture_time_s"] = ToSeconds(step.wall_minus_time);
    json["steps"].push_back(std::move(item));
  }
  return json;
}

Json LogJson(const std::vector<RecordedLog>& log) {
  Json json;
  for (const RecordedLog& entry : log) {
    Json line;
    line["time"] = FormatStamp(entry.time);
    line["level"] = entry.level;
    line["text"] = entry.text;
    json.push_back(std::move(line));
  }
  return json;
}

Json CalibrationJson(const std::optional<Rig>& rig) {
  Json json;
  json["present"] = rig.has_value();
  if (!rig) return json;
  json["depth"] = rig->depth.has_value();
  json["thermal"] = rig->thermal.has_value();
  json["T_thermal_depth"] = rig->T_thermal_depth.has_value();
  json["thermal_delay_s"] = rig->thermal_delay_s;
  json["thermal_scale"] = rig->thermal_scale.kelvin_per_count;
  json["thermal_offset"] = rig->thermal_scale.offset_kelvin;
  const RigCalibration calibration = ToProto(*rig);
  json["depth_sensor"] = ToJson(calibration.depth_sensor());
  json["thermal_sensor"] = ToJson(calibration.thermal_sensor());
  return json;
}

/// Sets json[key] if there is something to say.
void SetUnlessEmpty(Json& json, const char* key, Json value) {
  if (!value.empty()) json[key] = std::move(value);
}

}  // namespace

Json ToJson(const RecordingReport& report) {
  Json json;
  json["file"] = report.file;
  json["bytes"] = report.file_bytes;
  json["complete"] = report.info.complete;
  json["damaged"] = IsDamaged(report);
  json["bytes_ignored"] = report.info.bytes_ignored;
  json["depth_frames_lost"] = UnreadDepth(report);
  json["thermal_frames_lost"] = UnreadThermal(report);
  SetUnlessEmpty(json, "gaps", GapsJson(report.info.gaps));
  json["viewable"] = IsViewable(report.summary);
  json["unreadable_messages"] = report.summary.unreadable;
  json["depth"] = StreamJson(report.summary.depth);
  json["thermal"] = StreamJson(report.summary.thermal);
  json["nuc"] = NucJson(report.summary);
  SetUnlessEmpty(json, "clock", ClockJson(report));
  for (const auto& [stream, count] : report.summary.poses) json["poses"][stream] = count;
  for (const auto& [source, count] : report.summary.external_odometry)
    json["external_odometry"][source] = count;
  SetUnlessEmpty(json, "log", LogJson(report.summary.log));
  json["log_left_out"] = report.summary.log_left_out;
  for (const auto& [topic, count] : report.info.messages_by_topic) json["messages"][topic] = count;
  for (const auto& [name, values] : report.info.metadata) {
    for (const auto& [key, value] : values) json["metadata"][name][key] = value;
  }
  for (const std::string& doubt : report.doubts) json["warnings"].push_back(doubt);
  json["calibration"] = CalibrationJson(report.rig);
  return json;
}

}  // namespace isotherm
