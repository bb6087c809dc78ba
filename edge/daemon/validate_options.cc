#include "edge/daemon/validate_options.h"

#include <fmt/format.h>

#include <cmath>
#include <sstream>
#include <string>
#include <string_view>

#include "edge/options/edge_options.pb.h"

namespace isotherm {
namespace {

/// Collects problems under one stage's name.
class Problems {
 public:
  void Stage(std::string_view stage) { stage_ = stage; }

  /// `value` must lie in [lowest, highest]. NaN does not.
  template <typename T>
  void CheckRange(std::string_view field, T value, T lowest, T highest) {
    if (value >= lowest && value <= highest) return;
    Add(field, fmt::format("is {}, must be from {} to {}", value, lowest, highest));
  }
  void Add(std::string_view field, std::string_view problem) {
    text_ += fmt::format("{}{}{}{}: {}", text_.empty() ? "" : "\n", stage_,
                         stage_.empty() ? "" : ".", field, problem);
  }
  Status ToStatus() const { return text_.empty() ? OkStatus() : InvalidArgument(text_); }

 private:
  std::string_view stage_;
  std::string text_;
};

bool IsPlainName(const std::string& name) {
  constexpr std::string_view kAllowed =
      "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-.";
  return !name.empty() && name.size() <= 32 &&
         name.find_first_not_of(kAllowed) == std::string::npos;
}

void CheckDepthCamera(const SourceOptions& source, Problems& problems) {
  problems.Stage("source.depth_camera");
  const DepthCameraOptions& options = source.depth_camera();
  problems.CheckRange("width", options.width(), 16, 4096);
  problems.CheckRange("height", options.height(), 16, 4096);
  problems.CheckRange("rate_hz", options.rate_hz(), 1, 240);
  problems.CheckRange("stall_timeout_s", options.stall_timeout_s(), 0.2, 60.0);
  problems.Stage("source");
  const bool is_file = options.uri().ends_with(".oni") && !source.thermal_camera().enabled();
  if (source.rate() != 1.0 && !is_file) {
    problems.Add("rate", fmt::format("is {}, but cameras have a pace of their own: leave it at 1",
                                     source.rate()));
  }
  if (!options.enabled() && !source.thermal_camera().enabled()) {
    problems.Add("depth_camera.enabled",
                 "is false, and thermal_camera.enabled too: no camera is left");
  }
}

void CheckSource(const SourceOptions& options, Problems& problems) {
  problems.Stage("source");
  problems.CheckRange("rate", options.rate(), 0.0, 100.0);
  problems.CheckRange("loops", options.loops(), 0, 1'000'000);
  if (options.kind() == REPLAY && options.recording().empty()) {
    problems.Add("recording", "is empty; name the file to replay (--recording FILE)");
  }
  if (options.kind() == CAMERAS) CheckDepthCamera(options, problems);
}

void CheckThermalCamera(const ThermalCameraOptions& options, Problems& problems) {
  problems.Stage("source.thermal_camera");
  problems.CheckRange("stall_timeout_s", options.stall_timeout_s(), 0.2, 60.0);
  problems.CheckRange("kelvin_per_count", options.kelvin_per_count(), 0.0, 10.0);
  problems.CheckRange("offset_kelvin", options.offset_kelvin(), -1e5, 1e4);
  if (options.has_optris_min_celsius() != options.has_optris_max_celsius()) {
    problems.Add(options.has_optris_min_celsius() ? "optris_max_celsius" : "optris_min_celsius",
                 "is not set: a range has two ends");
  } else if (options.has_optris_min_celsius() &&
             options.optris_max_celsius() <= options.optris_min_celsius()) {
    problems.Add("optris_max_celsius",
                 fmt::format("is {}, must be above optris_min_celsius, which is {}",
                             options.optris_max_celsius(), options.optris_min_celsius()));
  }
}

/// Paths separated by ':'. A relative one would be looked for in the folder that the daemon happens
/// to be started in.
void CheckPaths(std::string_view field, const std::string& separated, Problems& problems) {
  std::istringstream words(separated);
  for (std::string path; std::getline(words, path, ':');) {
    if (path.empty() || path.front() == '/') continue;
    problems.Add(field, fmt::format("names \"{}\", must name paths from / on", path));
  }
}

void CheckSandbox(const CameraSandboxOptions& options, Problems& problems) {
  problems.Stage("source.camera_sandbox");
  CheckPaths("read", options.read(), problems);
  CheckPaths("write", options.write(), problems);
}

void CheckFrames(const FrameCheckOptions& options, Problems& problems) {
  problems.Stage("frame_check");
  problems.CheckRange("min_celsius", options.min_celsius(), -273.0, 382.0);
  problems.CheckRange("max_celsius", options.max_celsius(), -273.0, 382.19);
  if (options.max_celsius() <= options.min_celsius()) {
    problems.Add("max_celsius", fmt::format("is {}, must be above min_celsius, which is {}",
                                            options.max_celsius(), options.min_celsius()));
  }
  problems.CheckRange("max_bad_in_a_row", options.max_bad_in_a_row(), 1, 100'000);
  problems.CheckRange("retry_min_s", options.retry_min_s(), 0.01, 60.0);
  problems.CheckRange("min_valid_ratio", options.min_valid_ratio(), 0.0, 1.0);
  problems.CheckRange("blind_after_s", options.blind_after_s(), 0.0, 60.0);
  problems.CheckRange("retry_max_s", options.retry_max_s(), options.retry_min_s(), 600.0);
}

void CheckTimestamper(const TimestamperOptions& options, Problems& problems) {
  problems.Stage("timestamper");
  problems.CheckRange("depth_window", options.depth_window(), 1, 1000);
  problems.CheckRange("thermal_window", options.thermal_window(), 1, 1000);
  problems.CheckRange("depth_delay_s", options.depth_delay_s(), -1.0, 1.0);
  problems.CheckRange("thermal_delay_s", options.thermal_delay_s(), -1.0, 1.0);
  problems.CheckRange("envelope_window_s", options.envelope_window_s(), 1.0, 600.0);
  problems.CheckRange("max_skew_ppm", options.max_skew_ppm(), 0.0, 100'000.0);
  problems.CheckRange("max_slew_ppm", options.max_slew_ppm(), 1.0, 100'000.0);
  problems.CheckRange("early_limit_s", options.early_limit_s(), 0.0001, 10.0);
  problems.CheckRange("residual_limit_s", options.residual_limit_s(), 0.0001, 10.0);
  problems.CheckRange("residual_window_s", options.residual_window_s(), 0.1,
                      options.envelope_window_s());
  problems.CheckRange("relearn_after_s", options.relearn_after_s(), 0.1, 600.0);
}

void CheckNuc(const NucOptions& options, Problems& problems) {
  constexpr double kHour = 3600.0;
  problems.Stage("nuc");
  problems.CheckRange("settle_time_s", options.settle_time_s(), 0.0, 60.0);
  problems.CheckRange("max_housing_drift_k", options.max_housing_drift_k(), 0.0, 100.0);
  problems.CheckRange("max_fpa_drift_k", options.max_fpa_drift_k(), 0.0, 100.0);
  problems.CheckRange("max_interval_s", options.max_interval_s(), 0.0, 24.0 * kHour);
  problems.CheckRange("min_interval_s", options.min_interval_s(), 0.5, kHour);
  problems.CheckRange("max_hold_s", options.max_hold_s(), 0.0, kHour);
  problems.CheckRange("answer_s", options.answer_s(), 0.1, 60.0);
  problems.CheckRange("max_attempts", options.max_attempts(), 1, 100);
  problems.CheckRange("max_duration_s", options.max_duration_s(), 0.1, 600.0);
  problems.CheckRange("commanded_duration_s", options.commanded_duration_s(), 0.0, 60.0);
  problems.CheckRange("native_repeats", options.native_repeats(), 1, 100);
  problems.CheckRange("shutter_like_spread", options.shutter_like_spread(), 0.0, 1.0);
  problems.CheckRange("max_closings_per_minute", options.max_closings_per_minute(), 1, 600);
  problems.CheckRange("warm_up_rate_k_per_min", options.warm_up_rate_k_per_min(), 0.001, 100.0);
  problems.CheckRange("warm_up_stable_s", options.warm_up_stable_s(), 1.0, kHour);
  problems.CheckRange("warm_up_time_s", options.warm_up_time_s(), 0.0, 24.0 * kHour);
  problems.CheckRange("frozen_restart_s", options.frozen_restart_s(), 0.0, 600.0);
}

void CheckSpool(const SpoolOptions& options, Problems& problems) {
  problems.Stage("spool");
  if (options.record().empty()) problems.Add("record", "is empty; name a file or say \"off\"");
  problems.CheckRange("queue_frames", options.queue_frames(), 1, 100'000);
  problems.CheckRange("flush_interval_s", options.flush_interval_s(), 0.05, 1.0);
  problems.CheckRange("reserve_s", options.reserve_s(), 0.0, 86'400.0);
  problems.CheckRange("reserve_mb", options.reserve_mb(), 0, 1'000'000);
  problems.CheckRange("warn_s", options.warn_s(), 0.0, 86'400.0);
}

void CheckLink(const LinkOptions& options, Problems& problems) {
  problems.Stage("link");
  if (!options.edge_id().empty() && !IsPlainName(options.edge_id())) {
    problems.Add("edge_id",
                 fmt::format("is \"{}\", must be 1 to 32 letters, digits, '_', '-' or '.'",
                             options.edge_id()));
  }
  problems.CheckRange("domain", options.domain(), 0, 230);
  problems.CheckRange("queue_frames", options.queue_frames(), 1, 100'000);
  problems.CheckRange("linger_s", options.linger_s(), 0.0, 3600.0);
}

}  // namespace

Status Validate(const EdgeOptions& options) {
  Problems problems;
  CheckSource(options.source(), problems);
  CheckThermalCamera(options.source().thermal_camera(), problems);
  CheckSandbox(options.source().camera_sandbox(), problems);
  CheckFrames(options.frame_check(), problems);
  problems.Stage("");
  problems.CheckRange("capture_queue_frames", options.capture_queue_frames(), 1, 1000);
  CheckTimestamper(options.timestamper(), problems);
  CheckNuc(options.nuc(), problems);
  CheckSpool(options.spool(), problems);
  CheckLink(options.link(), problems);
  problems.Stage("display");
  const std::string& image = options.display().image_file();
  if (!image.empty() && image.back() == '/')
    problems.Add("image_file", fmt::format("is \"{}\", must name a file", image));
  return problems.ToStatus();
}

}  // namespace isotherm
