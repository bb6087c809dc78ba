#include "ground/cli/recording_report.h"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <ctime>

#include "common/base/printable.h"
#include "common/dataset/text_lines.h"
#include "common/recording/clock_record.h"
#include "ground/cli/recording_damage.h"
#include "ground/conversion/convert_recording.h"

namespace isotherm {
namespace {

// " (date time UTC)"; nothing for stamps that do not count from 1970, as those of many data sets.
std::string Utc(CaptureTime time) {
  // Stamps that count from a camera's start lie in 1970.
  constexpr int kFirstPlausibleYear = 2000;
  const std::time_t seconds = static_cast<std::time_t>(ToSeconds(time.time_since_epoch()));
  std::tm utc{};
  gmtime_r(&seconds, &utc);
  if (utc.tm_year + 1900 < kFirstPlausibleYear) return {};
  return fmt::format(" ({:04}-{:02}-{:02} {:02}:{:02}:{:02} UTC)", utc.tm_year + 1900,
                     utc.tm_mon + 1, utc.tm_mday, utc.tm_hour, utc.tm_min, utc.tm_sec);
}

std::string Size(const StreamSummary& stream) {
  std::string text;
  for (const auto& [width, height] : stream.sizes) {
    text += fmt::format("{}{} x {}", text.empty() ? "" : " and ", width, height);
  }
  return text;
}

std::string Encodings(const StreamSummary& stream) {
  std::string text;
  for (const auto& [name, count] : stream.encodings) {
    text += (text.empty() ? "" : ", ") + name;
    // Counts say something only where there are several.
    if (stream.encodings.size() > 1) text += fmt::format(" ({})", count);
  }
  return text;
}

void AppendStream(std::string_view name, const StreamSummary& stream, std::string& text) {
  if (stream.frames == 0) {
    text += fmt::format("{:<14}none\n", name);
    return;
  }
  text += fmt::format("{:<14}{} frames of {} pixels", name, stream.frames, Size(stream));
  if (stream.period_s > 0.0) text += fmt::format(" at {:.2f} Hz", stream.rate_hz());
  text += fmt::format(" over {:.3f} s\n", ToSeconds(stream.last - stream.first));
  constexpr std::string_view kIndent = "              ";
  text += fmt::format("{}stored as {}, {:.1f} % of {:.1f} MB raw\n", kIndent, Encodings(stream),
                      100.0 * stream.compression(), 1e-6 * static_cast<double>(stream.raw_bytes));
  text += fmt::format("{}{} missing", kIndent, stream.missing);
  if (stream.holes > 0) text += fmt::format(" in {} holes", stream.holes);
  text += fmt::format(", {} duplicate, {} out of order, {} repeat the image before\n",
                      stream.duplicates, stream.out_of_order, stream.repeats);
  if (stream.gaps == 0) {
    text += fmt::format("{}no time gaps\n", kIndent);
  } else {
    text += fmt::format("{}{} time gap{} over 1.5 periods, the longest {:.1f} ms after {}\n",
                        kIndent, stream.gaps, stream.gaps == 1 ? "" : "s",
                        1e3 * stream.longest_gap_s, FormatStamp(stream.longest_gap_at));
  }
  if (stream.sigma_s > 0.0)
    text += fmt::format("{}capture time +-{:.3f} ms\n", kIndent, 1e3 * stream.sigma_s);
  if (stream.sessions.size() > 1)
    text += fmt::format("{}{} sessions\n", kIndent, stream.sessions.size());
}

void AppendFormat(const RecordingReport& report, std::string& text) {
  if (report.summary.depth.frames + report.summary.thermal.frames == 0) return;
  const bool viewable = IsViewable(report.summary);
  text += fmt::format(
      "{:<14}{} (isotherm convert {} -o OUT.mcap --encoding {} makes one that {})\n", "images",
      viewable ? "viewable: Foxglove and Lichtblick show them"
               : "compact: lossless, only Isotherm reads them",
      report.file, viewable ? "compact" : "viewable",
      viewable ? "is smaller" : "Foxglove and Lichtblick show");
}

/// Appends what was done to the images on purpose: nobody should take them for what a camera sent.
void AppendSpoiled(const RecordingInfo& info, std::string& text) {
  const auto found = info.metadata.find(std::string(kSpoiledMetadata));
  if (found == info.metadata.end()) return;
  for (const auto& [stream, defects] : found->second) {
    text += fmt::format("{:<14}{} images are not what the camera sent: {} (isotherm convert)\n",
                        "SPOILED", Printable(stream), Printable(defects));
  }
}

void AppendNuc(const RecordingSummary& summary, std::string& text) {
  if (summary.thermal.frames == 0) return;
  text += fmt::format("{:<14}{} of {} thermal frames valid;", "shutter", summary.valid_thermal,
                      summary.thermal.frames);
  std::string states;
  for (const auto& [name, count] : summary.nuc_states)
    states += fmt::format("{} {} {}", states.empty() ? "" : ",", count, name);
  text += states + "\n";
  for (const NucRun& run : summary.nuc_runs) {
    text += fmt::format("{:<14}closed from {} to {} ({} frames)\n", "", FormatStamp(run.start),
                        FormatStamp(run.end), run.frames);
  }
  for (const NucEvent& event : summary.nuc_events) {
    text += fmt::format("{:<14}event from {} to {} ({:.3f} s)\n", "", FormatStamp(event.start),
                        FormatStamp(event.end), ToSeconds(event.end - event.start));
  }
}

/// Says how good the clock was that stamped the frames, and what to add to their times to get UTC.
void AppendClock(const RecordingReport& report, std::string& text) {
  if (const std::string state = ClockState(report.info); !state.empty())
    text += fmt::format("{:<14}{}\n", "clock", Printable(state));
  for (const ClockStep& step : report.summary.clock_steps) {
    text += fmt::format(
        "{:<14}the wall clock was set by {:+.3f} s at {}: from there on UTC = capture time {:+.3f} "
        "s\n",
        "", ToSeconds(step.step), FormatStamp(step.time), ToSeconds(step.wall_minus_time));
  }
}

void AppendCamera(std::string_view name, const std::optional<CameraModel>& camera,
                  std::string& text) {
  if (!camera) {
    text += fmt::format("{:<14}{}: no intrinsics\n", "", name);
    return;
  }
  text += fmt::format("{:<14}{}: {} x {}, fx {:.2f} fy {:.2f} cx {:.2f} cy {:.2f}{}\n", "", name,
                      camera->width, camera->height, camera->fx, camera->fy, camera->cx, camera->cy,
                      camera->HasDistortion() ? ", with distortion" : "");
}

void AppendSensors(const Rig& rig, std::string& text) {
  const DepthSensorModel& depth = rig.depth_sensor;
  text += fmt::format(
      "{:<14}depth: {:g} to {:g} m, nothing seen nearer than {:g} m, noise {:g} mm at 1 m", "",
      depth.min_depth_m, depth.max_depth_m, depth.near_range_m, 1e3 * depth.noise_at_1m_m);
  if (const DepthBias& bias = depth.bias; !bias.empty()) {
    const auto [least, most] =
        std::minmax_element(bias.multipliers.begin(), bias.multipliers.end());
    text += fmt::format(", bias corrected by {:+.2f} to {:+.2f} %", 100.0 * (*least - 1.0),
                        100.0 * (*most - 1.0));
  }
  text += "\n";
  const ThermalSensorModel& thermal = rig.thermal_sensor;
  text += fmt::format("{:<14}thermal: time constant {:g} ms, {:g} us from row to row", "",
                      1e3 * thermal.time_constant_s, 1e6 * thermal.row_readout_s);
  if (thermal.scene_influence.Total() > 0.0) {
    text +=
        fmt::format(", scene influence {:g} within {:g} px and {:g} of the image",
                    thermal.scene_influence.near_fraction, thermal.scene_influence.near_sigma_px,
                    thermal.scene_influence.total_fraction);
  }
  if (const RadiometricCorrection& correction = thermal.radiometric_correction;
      !correction.empty()) {
    text += fmt::format(", readings corrected by {:+.2f} K at {:.0f} °C to {:+.2f} K at {:.0f} °C",
                        correction.corrections_k.front(), correction.readings_celsius.front(),
                        correction.corrections_k.back(), correction.readings_celsius.back());
  }
  if (thermal.housing_drift) {
    text += fmt::format(", {:+.2f} K for each kelvin of the housing taken out",
                        -thermal.housing_drift->error_per_kelvin);
  }
  if (thermal.pixel_pitch_m)
    text += fmt::format(", pixels of {:g} um", 1e6 * *thermal.pixel_pitch_m);
  if (thermal.lens) {
    text += fmt::format(", lens of {:g} mm f/{:g} focused at {:g} m",
                        1e3 * thermal.lens->focal_length_m, thermal.lens->f_number,
                        thermal.lens->focus_m);
  }
  text += "\n";
}

void AppendRig(const RecordingReport& report, std::string& text) {
  text += fmt::format("{:<14}", "calibration");
  if (!report.rig) {
    // Texts from a file may hold escape sequences, which would reach the terminal.
    text += Printable(report.rig_problem) + "\n";
    return;
  }
  const Rig& rig = *report.rig;
  text += fmt::format("{} depth units per metre, thermal delay {} s", rig.depth_scale,
                      rig.thermal_delay_s);
  if (rig.thermal_scale != kCentikelvin) {
    text += fmt::format(", thermal scale {:g} K from {:g} K on (up to {:.0f} °C)",
                        rig.thermal_scale.kelvin_per_count, rig.thermal_scale.offset_kelvin,
                        rig.thermal_scale.max_celsius());
  }
  if (!rig.serial.empty()) text += ", serial " + Printable(rig.serial);
  if (!rig.date.empty()) text += ", " + Printable(rig.date);
  text += "\n";
  AppendCamera("depth", rig.depth, text);
  AppendCamera("thermal", rig.thermal, text);
  if (rig.T_thermal_depth) {
    const Eigen::Vector3d t = 1e3 * rig.T_thermal_depth->translation();
    const double angle_deg =
        RotationAngle(RigidTransform::Identity(), *rig.T_thermal_depth) * 180.0 / 3.14159265358979;
    text += fmt::format("{:<14}T_thermal_depth: {:.1f} {:.1f} {:.1f} mm, {:.2f} degrees\n", "",
                        t.x(), t.y(), t.z(), angle_deg);
  } else {
    text += fmt::format("{:<14}no T_thermal_depth: temperatures cannot be fused\n", "");
  }
  AppendSensors(rig, text);
}

void AppendLog(const RecordingSummary& summary, std::string& text) {
  for (const RecordedLog& log : summary.log)
    text += fmt::format("{:<14}{} {}: {}\n", "log", FormatStamp(log.time), log.level,
                        Printable(log.text));
  if (summary.log_left_out > 0)
    text += fmt::format("{:<14}and {} lines more\n", "log", summary.log_left_out);
}

void AppendOther(const RecordingReport& report, std::string& text) {
  for (const auto& [stream, count] : report.summary.poses)
    text += fmt::format("{:<14}{} poses\n", Printable(stream), count);
  for (const auto& [source, count] : report.summary.external_odometry)
    text += fmt::format("{:<14}{} poses of \"{}\"\n", "odometry", count, Printable(source));
  for (const auto& [topic, count] : report.info.messages_by_topic) {
    text += fmt::format("{:<22}{} messages\n", Printable(topic), count);
  }
  for (const auto& [name, values] : report.info.metadata) {
    for (const auto& [key, value] : values) {
      // A whole configuration or rig file would fill the screen.
      const bool long_text = value.find('\n') != std::string::npos;
      text += fmt::format(
          "{:<22}{}: {}\n", Printable(name), Printable(key),
          long_text ? fmt::format("({} bytes of text)", value.size()) : Printable(value));
    }
  }
}

}  // namespace

bool IsViewable(const RecordingSummary& summary) {
  const auto is_plain = [](const StreamSummary& stream) {
    return std::ranges::all_of(stream.encodings, [](const auto& counted) {
      return counted.first == EncodingName(Encoding::kRaw16) ||
             counted.first == EncodingName(Encoding::kPng16) ||
             counted.first == EncodingName(Encoding::kCounts16) ||
             counted.first == EncodingName(Encoding::kScaledRaw16);
    });
  };
  return is_plain(summary.depth) && is_plain(summary.thermal);
}

std::string ClockState(const RecordingInfo& info) {
  const auto found = info.metadata.find(std::string(kClockMetadata));
  if (found == info.metadata.end()) return "";
  const auto value = [&found](const char* key) {
    const auto at = found->second.find(key);
    return at == found->second.end() ? std::string() : at->second;
  };
  std::string state = value("time_base");
  if (value("synchronised") == "yes") {
    state = fmt::format("synchronised, off by about {} s, at most {} s", value("estimated_error_s"),
                        value("max_error_s"));
  } else if (!value("synchronised").empty()) {
    state = "NOT SYNCHRONISED: capture times are right among themselves, but not as UTC";
  }
  if (!value("minus_ground_clock_s").empty()) {
    state += fmt::format("; minus the ground's {} s (+-{} s)", value("minus_ground_clock_s"),
                         value("minus_ground_clock_uncertainty_s"));
  }
  if (const std::string alarms = value("alarms"); !alarms.empty() && alarms != "0")
    state += ", CLOCK ALARM";
  return state;
}

RecordingReport MakeReport(RecordingReader& reader, const std::filesystem::path& path) {
  RecordingReport report;
  report.file = path.string();
  std::error_code error;
  report.file_bytes = std::filesystem::file_size(path, error);
  // The file was opened a moment ago: without its size the report is still useful.
  if (error) report.file_bytes = 0;
  report.info = reader.info();
  if (Result<Rig> rig = reader.ReadRig()) {
    report.rig = std::move(*rig);
  } else {
    report.rig_problem = rig.error().message();
  }
  PlausibilityCheck plausibility(report.rig.value_or(Rig()));
  report.summary = Summarize(reader, plausibility);
  report.doubts = plausibility.Find();
  return report;
}

std::string ToText(const RecordingReport& report) {
  std::string text = fmt::format("{}: {:.1f} MB, {}\n", Printable(report.file),
                                 1e-6 * static_cast<double>(report.file_bytes), StateText(report));
  text += DamageText(report);
  if (report.info.start && report.info.end) {
    text += fmt::format("{:<14}{} to {}{}\n", "time", FormatStamp(*report.info.start),
                        FormatStamp(*report.info.end), Utc(*report.info.start));
  }
  AppendFormat(report, text);
  AppendSpoiled(report.info, text);
  AppendStream("depth", report.summary.depth, text);
  AppendStream("thermal", report.summary.thermal, text);
  AppendNuc(report.summary, text);
  AppendClock(report, text);
  AppendRig(report, text);
  if (report.summary.unreadable > 0)
    text += fmt::format("{:<14}{} messages\n", "unreadable", report.summary.unreadable);
  AppendLog(report.summary, text);
  AppendOther(report, text);
  return text;
}

}  // namespace isotherm
