#include "common/options/renamed_options.h"

#include <fmt/format.h>
#include <google/protobuf/descriptor.h>

#include <map>
#include <string>
#include <vector>

#include "common/options/nearest_name.h"

namespace isotherm {
namespace {

/// Sorted as the messages are. Each name is also reserved in its message, and renamed_options_test
/// holds both together.
constexpr RenamedOption kRenamed[] = {
    {"VolumeOptions", "min_x_m", "expert.min_x_m"},
    {"VolumeOptions", "min_y_m", "expert.min_y_m"},
    {"VolumeOptions", "min_z_m", "expert.min_z_m"},
    {"VolumeOptions", "initial_pose", "expert.initial_pose"},
    {"VolumeOptions", "max_memory_bytes", "expert.max_memory_bytes"},
    {"PreprocessorOptions", "bilateral_radius_px", "expert.bilateral_radius_px"},
    {"PreprocessorOptions", "bilateral_sigma_px", "expert.bilateral_sigma_px"},
    {"PreprocessorOptions", "max_surface_angle_deg", "expert.max_surface_angle_deg"},
    {"PreprocessorOptions", "bilateral_sigma_depth_m", "depth_sensor.noise_at_1m_m",
     RenamedOption::Place::kRigFile},
    {"PreprocessorOptions", "min_depth_m", "expert.min_depth_m"},
    {"PreprocessorOptions", "max_depth_m", "expert.max_depth_m"},
    {"ExternalOdometryOptions", "max_gap_s", "expert.max_gap_s"},
    {"ExternalOdometryOptions", "max_ahead_s", "expert.max_ahead_s"},
    {"ExternalOdometryOptions", "max_speed_m_s", "expert.max_speed_m_s"},
    {"ExternalOdometryOptions", "max_rotation_deg_s", "expert.max_rotation_deg_s"},
    {"ExternalOdometryOptions", "max_disagreement_m", "expert.max_disagreement_m"},
    {"ExternalOdometryOptions", "drift_ratio", "expert.drift_ratio"},
    {"ExternalOdometryOptions", "position_sigma_m", "expert.position_sigma_m"},
    {"ExternalOdometryOptions", "rotation_sigma_deg", "expert.rotation_sigma_deg"},
    {"ExternalOdometryOptions", "max_turn_deg_s", "expert.max_rotation_deg_s"},
    {"ExternalOdometryOptions", "enabled", "expert.enabled"},
    {"ExternalOdometryOptions", "source", "expert.source"},
    {"TrackerOptions", "iterations_coarse", "expert.iterations_coarse"},
    {"TrackerOptions", "iterations_middle", "expert.iterations_middle"},
    {"TrackerOptions", "iterations_fine", "expert.iterations_fine"},
    {"TrackerOptions", "max_distance_m", "expert.max_distance_m"},
    {"TrackerOptions", "max_normal_angle_deg", "expert.max_normal_angle_deg"},
    {"TrackerOptions", "min_update_m", "expert.min_update_m"},
    {"TrackerOptions", "min_update_deg", "expert.min_update_deg"},
    {"TrackerOptions", "min_inlier_ratio", "expert.min_inlier_ratio"},
    {"TrackerOptions", "max_residual_m", "expert.max_residual_m"},
    {"TrackerOptions", "max_step_m", "expert.max_step_m"},
    {"TrackerOptions", "max_step_deg", "expert.max_step_deg"},
    {"TrackerOptions", "predict_motion", "expert.predict_motion"},
    {"TrackerOptions", "min_observed", "expert.min_observed"},
    {"TrackerOptions", "prior_sigma_m_s", "expert.prior_sigma_m_s"},
    {"TrackerOptions", "thermal_min_gradient_k_m", "expert.thermal_min_gradient_k_m"},
    {"TrackerOptions", "outside", "external_odometry"},
    {"RelocaliserOptions", "max_views", "expert.max_views"},
    {"RelocaliserOptions", "guesses_per_frame", "expert.guesses_per_frame"},
    {"RelocaliserOptions", "min_overlap", "expert.min_overlap"},
    {"RelocaliserOptions", "min_agreement", "expert.min_agreement"},
    {"RelocaliserOptions", "confirming_frames", "expert.confirming_frames"},
    {"RelocaliserOptions", "enabled", "expert.enabled"},
    {"SubMapOptions", "max_rotation_deg", "expert.max_rotation_deg"},
    {"SubMapOptions", "max_travel_m", "expert.max_travel_m"},
    {"SubMapOptions", "start_after_lost_s", "expert.start_after_lost_s"},
    {"SubMapOptions", "max_maps", "expert.max_maps"},
    {"SubMapOptions", "max_turn_deg", "expert.max_rotation_deg"},
    {"TsdfOptions", "max_weight", "expert.max_weight"},
    {"TsdfOptions", "min_step_m", "expert.min_step_m"},
    {"TsdfOptions", "max_step_m", "expert.max_step_m"},
    {"TsdfOptions", "min_step_deg", "expert.min_step_deg"},
    {"TsdfOptions", "max_step_deg", "expert.max_step_deg"},
    {"TsdfOptions", "bootstrap_frames", "expert.bootstrap_frames"},
    {"TsdfOptions", "distance", "expert.distance"},
    {"TsdfOptions", "truncation_distance_m", "expert.truncation_distance_m"},
    {"RaycastOptions", "min_weight", "expert.min_weight"},
    {"RaycastOptions", "halvings", "expert.halvings"},
    {"ThermalOptions", "distance_min_m", "distance.min_m"},
    {"ThermalOptions", "distance_good_m", "distance.good_m"},
    {"ThermalOptions", "distance_max_m", "distance.max_m"},
    {"ThermalOptions", "angle_min_deg", "angle.min_deg"},
    {"ThermalOptions", "angle_good_deg", "angle.good_deg"},
    {"ThermalOptions", "angle_max_deg", "angle.max_deg"},
    {"ThermalOptions", "vertex_distance_vox", "expert.vertex_distance_vox"},
    {"ThermalOptions", "validation", "expert.validation"},
    {"ThermalOptions", "max_wait_s", "expert.max_depth_gap_s"},
    {"ThermalOptions", "max_registration_px", "expert.max_registration_px"},
    {"ThermalOptions", "records", "expert.records"},
    {"ThermalOptions", "policy", "expert.policy"},
    {"ThermalOptions", "max_gradient_error_k", "expert.max_gradient_error_k"},
    {"ThermalOptions", "max_footprint_m", "expert.max_footprint_m"},
    {"ThermalOptions", "max_time_sigma_s", "expert.max_time_sigma_s"},
    {"ThermalOptions", "parallax_tolerance_m", "expert.occlusion.parallax_tolerance_m"},
    {"ThermalOptions", "edge_margin_px", "expert.occlusion.edge_margin_px"},
    {"ThermalOptions", "visibility_halvings", "expert.occlusion.visibility_halvings"},
    {"ThermalOptions", "hole_px", "expert.occlusion.hole_px"},
    {"ThermalOptions", "smear_good_px", "expert.motion.smear_good_px"},
    {"ThermalOptions", "smear_max_px", "expert.motion.smear_max_px"},
    {"ThermalOptions", "disagreement_noise_k", "expert.disagreement.noise_k"},
    {"ThermalOptions", "disagreement_good_k", "expert.disagreement.good_k"},
    {"ThermalOptions", "disagreement_max_k", "expert.disagreement.max_k"},
    {"ThermalOptions", "time_constant_s", "thermal_sensor.time_constant_s",
     RenamedOption::Place::kRigFile},
    {"ThermalOptions", "row_readout_s", "thermal_sensor.row_readout_s",
     RenamedOption::Place::kRigFile},
    {"ThermalOptions", "near_range_m", "depth_sensor.near_range_m", RenamedOption::Place::kRigFile},
    {"ThermalOptions", "lens", "thermal_sensor.lens", RenamedOption::Place::kRigFile},
    {"ThermalOptions", "keep_bad", "expert.keep_bad"},
    {"ThermalExpertOptions", "max_wait_s", "max_depth_gap_s"},
    {"RendererOptions", "shading", "expert.shading"},
    {"RendererOptions", "percentile_low", "expert.percentile_low"},
    {"RendererOptions", "percentile_high", "expert.percentile_high"},
    {"RendererOptions", "isotherm_width_px", "expert.isotherm_width_px"},
    {"RendererOptions", "isotherm_smoothing_px", "expert.isotherm_smoothing_px"},
    {"RendererOptions", "isotherms", "isotherm"},
    {"RendererOptions", "bands", "band"},
    {"RendererOptions", "legend", "expert.legend"},
    {"InterpretationOptions", "band_min_um", "expert.band_min_um"},
    {"InterpretationOptions", "band_max_um", "expert.band_max_um"},
    {"ExportOptions", "min_weight", "expert.min_weight"},
    {"ExportOptions", "cloud", "expert.cloud"},
    {"ExportOptions", "mesh", "expert.mesh"},
    {"ExportOptions", "renders", "expert.renders"},
    {"ExportOptions", "model", "expert.model"},
    {"LiveOptions", "record_viewable", "expert.record_viewable"},
    {"LiveOptions", "queue_frames", "expert.queue_frames"},
    {"LiveOptions", "feedback_hz", "expert.feedback_hz"},
    {"LiveOptions", "reorder_window_s", "expert.reorder_window_s"},
    {"LiveOptions", "max_wait_s", "expert.max_wait_s"},
    {"LiveOptions", "max_clock_offset_s", "expert.max_clock_offset_s"},
    {"FeedbackOptions", "advise_fraction", "expert.advise_fraction"},
    {"FeedbackOptions", "withdraw_fraction", "expert.withdraw_fraction"},
    {"FeedbackOptions", "settle_s", "expert.settle_s"},
    {"FeedbackOptions", "show_s", "expert.show_s"},
    {"FeedbackOptions", "blocks_per_message", "expert.blocks_per_message"},
    {"FeedbackOptions", "views_per_message", "expert.views_per_message"},
    {"FeedbackOptions", "min_gain_m2", "expert.min_gain_m2"},
    {"FeedbackOptions", "image_width_px", "expert.image_width_px"},
    {"FeedbackOptions", "done_share", "done_fraction"},
    {"FeedbackOptions", "advise_share", "expert.advise_fraction"},
    {"FeedbackOptions", "withdraw_share", "expert.withdraw_fraction"},
    {"FeedbackOptions", "picture_width_px", "expert.image_width_px"},
    {"GroundOptions", "delay_check", "calibration_check"},
    {"DepthCameraOptions", "unit", "expert.unit"},
    {"DepthCameraOptions", "registration", "expert.registration"},
    {"DepthCameraOptions", "close_range", "expert.close_range"},
    {"DepthCameraOptions", "stall_timeout_s", "expert.stall_timeout_s"},
    {"DepthCameraOptions", "own_process", "expert.own_process"},
    {"DepthCameraOptions", "width", "expert.width"},
    {"DepthCameraOptions", "height", "expert.height"},
    {"DepthCameraOptions", "rate_hz", "expert.rate_hz"},
    {"ThermalCameraOptions", "bus_port", "expert.bus_port"},
    {"ThermalCameraOptions", "stall_timeout_s", "expert.stall_timeout_s"},
    {"ThermalCameraOptions", "kelvin_per_count", "expert.kelvin_per_count"},
    {"ThermalCameraOptions", "offset_kelvin", "expert.offset_kelvin"},
    {"ThermalCameraOptions", "optris_library", "expert.optris_library"},
    {"ThermalCameraOptions", "optris_formats", "expert.optris_formats"},
    {"ThermalCameraOptions", "optris_config", "expert.optris_config"},
    {"ThermalCameraOptions", "optris_min_celsius", "expert.optris_min_celsius"},
    {"ThermalCameraOptions", "optris_max_celsius", "expert.optris_max_celsius"},
    {"CameraSandboxOptions", "read", "expert.read"},
    {"CameraSandboxOptions", "write", "expert.write"},
    {"CameraSandboxOptions", "local_sockets", "expert.local_sockets"},
    {"CameraSandboxOptions", "enabled", "expert.enabled"},
    {"SourceOptions", "rebase", "expert.rebase"},
    {"SourceOptions", "cache_dir", "expert.cache_dir"},
    {"FrameCheckOptions", "min_celsius", "expert.min_celsius"},
    {"FrameCheckOptions", "max_celsius", "expert.max_celsius"},
    {"FrameCheckOptions", "max_bad_in_a_row", "expert.max_bad_in_a_row"},
    {"FrameCheckOptions", "retry_min_s", "expert.retry_min_s"},
    {"FrameCheckOptions", "retry_max_s", "expert.retry_max_s"},
    {"FrameCheckOptions", "min_valid_ratio", "expert.min_valid_ratio"},
    {"FrameCheckOptions", "blind_after_s", "expert.blind_after_s"},
    {"TimestamperOptions", "depth_window", "expert.depth_window"},
    {"TimestamperOptions", "thermal_window", "expert.thermal_window"},
    {"TimestamperOptions", "depth_delay_s", "expert.depth_delay_s"},
    {"TimestamperOptions", "thermal_delay_s", "expert.thermal_delay_s"},
    {"TimestamperOptions", "envelope_window_s", "expert.envelope_window_s"},
    {"TimestamperOptions", "max_skew_ppm", "expert.max_skew_ppm"},
    {"TimestamperOptions", "max_slew_ppm", "expert.max_slew_ppm"},
    {"TimestamperOptions", "early_limit_s", "expert.early_limit_s"},
    {"TimestamperOptions", "residual_limit_s", "expert.residual_limit_s"},
    {"TimestamperOptions", "residual_window_s", "expert.residual_window_s"},
    {"TimestamperOptions", "relearn_after_s", "expert.relearn_after_s"},
    {"TimestamperOptions", "estimator", "expert.estimator"},
    {"NucOptions", "require_initial_nuc", "expert.require_initial_nuc"},
    {"NucOptions", "max_fpa_drift_k", "expert.max_fpa_drift_k"},
    {"NucOptions", "min_interval_s", "expert.min_interval_s"},
    {"NucOptions", "max_hold_s", "expert.max_hold_s"},
    {"NucOptions", "answer_s", "expert.answer_s"},
    {"NucOptions", "max_attempts", "expert.max_attempts"},
    {"NucOptions", "max_duration_s", "expert.max_duration_s"},
    {"NucOptions", "commanded_duration_s", "expert.commanded_duration_s"},
    {"NucOptions", "native_repeats", "expert.native_repeats"},
    {"NucOptions", "shutter_like_spread", "expert.shutter_like_spread"},
    {"NucOptions", "max_closings_per_minute", "expert.max_closings_per_minute"},
    {"NucOptions", "warm_up_rate_k_per_min", "expert.warm_up_rate_k_per_min"},
    {"NucOptions", "warm_up_stable_s", "expert.warm_up_stable_s"},
    {"NucOptions", "warm_up_time_s", "expert.warm_up_time_s"},
    {"NucOptions", "frozen_restart_s", "expert.frozen_restart_s"},
    {"NucOptions", "settle_time_s", "expert.settle_time_s"},
    {"NucOptions", "max_housing_drift_k", "expert.max_housing_drift_k"},
    {"SpoolOptions", "queue_frames", "expert.queue_frames"},
    {"SpoolOptions", "flush_interval_s", "expert.flush_interval_s"},
    {"SpoolOptions", "warn_s", "expert.warn_s"},
    {"SpoolOptions", "reserve_s", "expert.reserve_s"},
    {"SpoolOptions", "reserve_mb", "expert.reserve_mb"},
    {"LinkOptions", "queue_frames", "expert.queue_frames"},
    {"LinkOptions", "linger_s", "expert.linger_s"},
    {"DisplayOptions", "picture_file", "image_file"},
    {"EdgeOptions", "capture_queue_frames", "source.expert.capture_queue_frames"},
    {"SimulatedDepthOptions", "baseline_m", "expert.baseline_m"},
    {"SimulatedDepthOptions", "disparity_step_px", "expert.disparity_step_px"},
    {"SimulatedDepthOptions", "disparity_noise_px", "expert.disparity_noise_px"},
    {"SimulatedDepthOptions", "min_depth_m", "expert.min_depth_m"},
    {"SimulatedDepthOptions", "max_depth_m", "expert.max_depth_m"},
    {"SimulatedDepthOptions", "grazing_start_deg", "expert.grazing_start_deg"},
    {"SimulatedDepthOptions", "grazing_end_deg", "expert.grazing_end_deg"},
    {"SimulatedDepthOptions", "edge_dropout", "expert.edge_dropout"},
    {"SimulatedDepthOptions", "depth_scale", "expert.depth_scale"},
    {"SimulatedThermalOptions", "netd_kelvin", "expert.netd_kelvin"},
    {"SimulatedThermalOptions", "blur_px", "expert.blur_px"},
    {"SimulatedThermalOptions", "band_min_um", "expert.band_min_um"},
    {"SimulatedThermalOptions", "band_max_um", "expert.band_max_um"},
    {"SimulatedThermalOptions", "time_constant_s", "expert.time_constant_s"},
    {"SimulatedThermalOptions", "readout_s", "expert.readout_s"},
    {"ShutterOptions", "appearance", "expert.appearance"},
    {"ShutterOptions", "shutter_celsius", "expert.shutter_celsius"},
    {"ShutterOptions", "duration_step_s", "expert.duration_step_s"},
    {"ShutterOptions", "drift_k", "expert.drift_k"},
    {"ShutterOptions", "reports_shutter", "expert.reports_shutter"},
    {"ShutterOptions", "order_delay_s", "expert.order_delay_s"},
    {"ShutterOptions", "follows_orders", "expert.follows_orders"},
    {"ShutterOptions", "tells", "expert.reports_shutter"},
    {"ShutterOptions", "obeys", "expert.follows_orders"},
    {"ClockOptions", "impulse_share", "impulse_fraction"},
    {"SimulationOptions", "start_time_ns", "expert.start_time_ns"},
    {"SimulationOptions", "thermal_phase_s", "expert.thermal_phase_s"},
};

/// Collects where the options of a message and of its expert block stand, by their names.
void CollectPlaces(const google::protobuf::Descriptor& type, const std::string& prefix,
                   std::map<std::string, std::string>& places) {
  for (int i = 0; i < type.field_count(); ++i) {
    const google::protobuf::FieldDescriptor& field = *type.field(i);
    places.try_emplace(field.name(), prefix + field.name());
    const bool is_expert = !prefix.empty() || field.name() == "expert";
    if (is_expert && field.message_type() != nullptr && !field.is_repeated())
      CollectPlaces(*field.message_type(), prefix + field.name() + ".", places);
  }
}

struct RenamedFlag {
  std::string_view before;
  std::string_view now;
};

constexpr RenamedFlag kRenamedFlags[] = {
    {"--outside-poses", "--external-odometry"},
};

}  // namespace

std::span<const RenamedOption> RenamedOptions() { return kRenamed; }

const RenamedOption* FindRenamed(const google::protobuf::Descriptor& type, std::string_view name) {
  for (const RenamedOption& option : kRenamed) {
    if (option.type == type.name() && option.before == name) return &option;
  }
  return nullptr;
}

std::string_view FlagSinceRenaming(std::string_view flag) {
  const std::string_view name = flag.substr(0, flag.find('='));
  for (const RenamedFlag& renamed : kRenamedFlags) {
    if (renamed.before == name) return renamed.now;
  }
  return {};
}

std::string SuggestOption(const google::protobuf::Descriptor& type, std::string_view name,
                          std::string_view parent) {
  if (const RenamedOption* renamed = FindRenamed(type, name)) {
    if (renamed->place == RenamedOption::Place::kRigFile)
      return fmt::format(" It belongs to the camera: '{}' of the rig file.", renamed->now);
    return fmt::format(" It is called '{}{}{}' now.", parent, parent.empty() ? "" : ".",
                       renamed->now);
  }
  std::map<std::string, std::string> places;
  CollectPlaces(type, "", places);
  std::vector<std::string> known;
  for (int i = 0; i < type.field_count(); ++i) known.push_back(type.field(i)->name());
  if (const std::string nearest = DidYouMean(name, known); !nearest.empty()) return nearest;
  for (const auto& [deeper, place] : places) known.push_back(deeper);
  const std::string nearest = NearestName(name, known);
  return nearest.empty() ? "" : fmt::format(" Did you mean '{}'?", places.at(nearest));
}

}  // namespace isotherm
