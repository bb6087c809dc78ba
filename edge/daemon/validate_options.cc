#include "edge/daemon/validate_options.h"

#include <fmt/format.h>

#include <cmath>
#include <string>
#include <string_view>

#include "common/base/units.h"
#include "common/frame/radiometric_scale.h"
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
    // Written so that NaN fails.
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
  problems.CheckRange("expert.stall_timeout_s", options.expert().stall_timeout_s(), 0.2, 60.0);
  problems.Stage("source");
  // OpenNI2 plays a file at any rate; beside a real camera it must keep to real time.
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
  problems.CheckRange("expert.stall_timeout_s", options.expert().stall_timeout_s(), 0.2, 60.0);
  problems.CheckRange("expert.kelvin_per_count", options.expert().kelvin_per_count(), 0.0, 10.0);
  problems.CheckRange("expert.offset_kelvin", options.expert().offset_kelvin(), -1e5, 1e4);
  // It becomes the frames' scale where centi-kelvin would cut it off.
  const RadiometricScale own{options.expert().kelvin_per_count(), options.expert().offset_kelvin()};
  if (own.kelvin_per_count > 0.0 && own.max_celsius() > kCentikelvin.max_celsius()) {
    if (Status status = Validate(own); !status.ok())
      problems.Add("expert.kelvin_per_count", status.message());
  }
  if (options.has_optris_min_celsius() != options.has_optris_max_celsius()) {
    problems.Add(options.has_optris_min_celsius() ? "optris_max_celsius" : "optris_min_celsius",
                 "is not set: a range has two ends");
  } else if (options.has_optris_min_celsius() &&
             options.optris_max_celsius() <= options.optris_min_celsius()) {
    problems.Add("optris_max_celsius",
                 fmt::format("is {}, must be above optris_min_celsius, which is {}",
                             options.optris_max_celsius(), options.optris_min_celsius()));
  } else if (options.has_optris_min_celsius()) {
    // Found out now instead of when the camera is opened.
    const auto scale = ScaleForRange(options.optris_min_celsius(), options.optris_max_celsius());
    if (!scale) problems.Add("optris_max_celsius", scale.error().message());
  }
}

/// A relative path would be looked for in the folder that the daemon happens to be started in.
void CheckPaths(std::string_view field,
                const google::protobuf::RepeatedPtrField<std::string>& paths, Problems& problems) {
  for (const std::string& path : paths) {
    if (!path.empty() && path.front() == '/') continue;
    problems.Add(field, fmt::format("names \"{}\", must name a path from / on", path));
  }
}

void CheckSandbox(const CameraSandboxOptions& options, Problems& problems) {
  problems.Stage("source.camera_sandbox.expert");
  CheckPaths("read", options.expert().read(), problems);
  CheckPaths("write", options.expert().write(), problems);
}

void CheckFrames(const FrameCheckOptions& options, Problems& problems) {
  problems.Stage("frame_check");
  problems.CheckRange("expert.min_celsius", options.expert().min_celsius(), -273.0, 3000.0);
  problems.CheckRange("expert.max_celsius", options.expert().max_celsius(), -273.0, 3000.0);
  if (options.expert().max_celsius() <= options.expert().min_celsius()) {
    problems.Add("expert.max_celsius",
                 fmt::format("is {}, must be above min_celsius, which is {}",
                             options.expert().max_celsius(), options.expert().min_celsius()));
  }
  problems.CheckRange("expert.max_bad_in_a_row", options.expert().max_bad_in_a_row(), 1, 100'000);
  problems.CheckRange("expert.retry_min_s", options.expert().retry_min_s(), 0.01, 60.0);
  problems.CheckRange("expert.min_valid_ratio", options.expert().min_valid_ratio(), 0.0, 1.0);
  problems.CheckRange("expert.blind_after_s", options.expert().blind_after_s(), 0.0, 60.0);
  // The longest wait is not below the first one: the back-off only grows.
  problems.CheckRange("expert.retry_max_s", options.expert().retry_max_s(),
                      options.expert().retry_min_s(), 600.0);
}

void CheckTimestamper(const TimestamperOptions& options, Problems& problems) {
  problems.Stage("timestamper");
  problems.CheckRange("expert.depth_window", options.expert().depth_window(), 1, 1000);
  problems.CheckRange("expert.thermal_window", options.expert().thermal_window(), 1, 1000);
  problems.CheckRange("expert.depth_delay_s", options.expert().depth_delay_s(), -1.0, 1.0);
  problems.CheckRange("expert.thermal_delay_s", options.expert().thermal_delay_s(), -1.0, 1.0);
  problems.CheckRange("expert.envelope_window_s", options.expert().envelope_window_s(), 1.0, 600.0);
  problems.CheckRange("expert.max_skew_ppm", options.expert().max_skew_ppm(), 0.0, 100'000.0);
  problems.CheckRange("expert.max_slew_ppm", options.expert().max_slew_ppm(), 1.0, 100'000.0);
  problems.CheckRange("expert.early_limit_s", options.expert().early_limit_s(), 0.0001, 10.0);
  problems.CheckRange("expert.residual_limit_s", options.expert().residual_limit_s(), 0.0001, 10.0);
  problems.CheckRange("expert.residual_window_s", options.expert().residual_window_s(), 0.1,
                      options.expert().envelope_window_s());
  problems.CheckRange("expert.relearn_after_s", options.expert().relearn_after_s(), 0.1, 600.0);
}

void CheckNuc(const NucOptions& options, Problems& problems) {
  problems.Stage("nuc");
  problems.CheckRange("settle_time_s", options.settle_time_s(), 0.0, 60.0);
  problems.CheckRange("max_housing_drift_k", options.max_housing_drift_k(), 0.0, 100.0);
  problems.CheckRange("expert.max_fpa_drift_k", options.expert().max_fpa_drift_k(), 0.0, 100.0);
  problems.CheckRange("max_interval_s", options.max_interval_s(), 0.0, 24.0 * kSPerHour);
  problems.CheckRange("expert.min_interval_s", options.expert().min_interval_s(), 0.5, kSPerHour);
  problems.CheckRange("expert.max_hold_s", options.expert().max_hold_s(), 0.0, kSPerHour);
  problems.CheckRange("expert.answer_s", options.expert().answer_s(), 0.1, 60.0);
  problems.CheckRange("expert.max_attempts", options.expert().max_attempts(), 1, 100);
  problems.CheckRange("expert.max_duration_s", options.expert().max_duration_s(), 0.1, 600.0);
  problems.CheckRange("expert.commanded_duration_s", options.expert().commanded_duration_s(), 0.0,
                      60.0);
  problems.CheckRange("expert.native_repeats", options.expert().native_repeats(), 1, 100);
  problems.CheckRange("expert.shutter_like_spread", options.expert().shutter_like_spread(), 0.0,
                      1.0);
  problems.CheckRange("expert.max_closings_per_minute", options.expert().max_closings_per_minute(),
                      1, 600);
  problems.CheckRange("expert.warm_up_rate_k_per_min", options.expert().warm_up_rate_k_per_min(),
                      0.001, 100.0);
  problems.CheckRange("expert.warm_up_stable_s", options.expert().warm_up_stable_s(), 1.0,
                      kSPerHour);
  problems.CheckRange("expert.warm_up_housing_rate_k_per_min",
                      options.expert().warm_up_housing_rate_k_per_min(), 0.001, 100.0);
  problems.CheckRange("expert.warm_up_housing_stable_s",
                      options.expert().warm_up_housing_stable_s(), 1.0, kSPerHour);
  problems.CheckRange("expert.warm_up_time_s", options.expert().warm_up_time_s(), 0.0,
                      24.0 * kSPerHour);
  problems.CheckRange("expert.frozen_restart_s", options.expert().frozen_restart_s(), 0.0, 600.0);
}

void CheckSpool(const SpoolOptions& options, Problems& problems) {
  problems.Stage("spool");
  if (options.record().empty()) problems.Add("record", "is empty; name a file or say \"off\"");
  problems.CheckRange("expert.queue_frames", options.expert().queue_frames(), 1, 100'000);
  problems.CheckRange("expert.flush_interval_s", options.expert().flush_interval_s(), 0.05, 1.0);
  problems.CheckRange("reserve_s", options.reserve_s(), 0.0, 86'400.0);
  problems.CheckRange("reserve_mb", options.reserve_mb(), 0, 1'000'000);
  problems.CheckRange("expert.warn_s", options.expert().warn_s(), 0.0, 86'400.0);
}

void CheckLink(const LinkOptions& options, Problems& problems) {
  problems.Stage("link");
  if (!options.edge_id().empty() && !IsPlainName(options.edge_id())) {
    problems.Add("edge_id",
                 fmt::format("is \"{}\", must be 1 to 32 letters, digits, '_', '-' or '.'",
                             options.edge_id()));
  }
  problems.CheckRange("domain", options.domain(), 0, 230);
  problems.CheckRange("expert.queue_frames", options.expert().queue_frames(), 1, 100'000);
  problems.CheckRange("expert.linger_s", options.expert().linger_s(), 0.0, 3600.0);
}

}  // namespace

Status Validate(const EdgeOptions& options) {
  Problems problems;
  CheckSource(options.source(), problems);
  CheckThermalCamera(options.source().thermal_camera(), problems);
  CheckSandbox(options.source().camera_sandbox(), problems);
  CheckFrames(options.frame_check(), problems);
  problems.Stage("source.expert");
  problems.CheckRange("capture_queue_frames", options.source().expert().capture_queue_frames(), 1,
                      1000);
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
